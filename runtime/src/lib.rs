//! Types of kernels that Imp compiled ahead of time.
#![no_std]
