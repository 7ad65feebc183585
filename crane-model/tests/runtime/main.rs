//! Statics, motion and modes: cranes written by hand, generated ones and live ones, against textbooks and hand calculations.

#[path = "../common/mod.rs"]
mod common;
mod dynamics;
mod ensemble;
mod envelope;
mod fixed;
#[path = "../common/live.rs"]
mod live;
mod modes;
mod shipped;
mod stability;
mod statics;
mod stiff;
mod weight;
