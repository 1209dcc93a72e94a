//! A real rig on scripted devices and a virtual clock.
