//! The runtime as its users see it. Every tolerance has its reason beside it.

mod converter;
mod noise;
mod random;

mod estimator;
mod extension;
mod fault;
mod filter;
mod monitor;
mod numeric;
mod observer;
mod paper;
