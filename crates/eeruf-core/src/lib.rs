//! *Error Eliminating Rapid Ultrasonic Firing* for rings of ultrasonic range sensors, without an allocator.
#![no_std]

pub mod search;
