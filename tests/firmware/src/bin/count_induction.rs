//! Counts the steps of the induction motor's observers, see `count!`.
#![cfg_attr(feature = "board", no_std)]
#![cfg_attr(feature = "board", no_main)]

pebo_firmware::count!(pebo_firmware::counted::induction::Induction);
