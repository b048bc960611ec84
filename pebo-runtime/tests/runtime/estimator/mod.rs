//! Estimators on given regressions and in the loop of the Cuk converter.

mod adaptive;
mod contract;
mod drem;
mod efficiency;
mod extremes;
mod gradient;
mod kalman;
mod settling;
