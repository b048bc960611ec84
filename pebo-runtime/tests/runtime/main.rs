//! The runtime as its users see it. Every tolerance has its reason beside it.

mod converter;
mod noise;
mod random;

mod double;
mod drem;
mod drift;
mod efficiency;
mod estimators;
mod extension;
mod extremes;
mod fault;
mod filter;
mod gradient;
mod kalman;
mod kinds;
mod monitor;
mod paper;
mod real;
mod rebasing;
mod sampling;
mod settling;
mod single;
mod storm;
mod within;
