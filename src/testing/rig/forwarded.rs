//! A rig that changes a few methods of another one, for tests. In: the field with the other rig, and the methods that it keeps. Out:
//! those methods.

/// Forwards these methods of [`Rig`](psd_rig::Rig) to the rig in a field.
#[macro_export]
macro_rules! forwarded {
    ($rig:tt: $($method:ident),+) => {
        $(forwarded!(@$method $rig);)+
    };
    (@identity $rig:tt) => {
        fn identity(&self) -> psd_rig::Identity {
            self.$rig.identity()
        }
    };
    (@degrees_of_freedom $rig:tt) => {
        fn degrees_of_freedom(&self) -> usize {
            self.$rig.degrees_of_freedom()
        }
    };
    (@time $rig:tt) => {
        fn time(&self) -> f64 {
            self.$rig.time()
        }
    };
    (@propose $rig:tt) => {
        fn propose(
            &mut self,
            targets: &[f64],
            speed: Option<f64>,
        ) -> Result<psd_rig::EncodedMove, psd_rig::RigFault> {
            self.$rig.propose(targets, speed)
        }
    };
    (@execute $rig:tt) => {
        fn execute(&mut self) -> Result<(), psd_rig::RigFault> {
            self.$rig.execute()
        }
    };
    (@pause $rig:tt) => {
        fn pause(&mut self, seconds: f64) -> Result<(), psd_rig::RigFault> {
            self.$rig.pause(seconds)
        }
    };
    (@read $rig:tt) => {
        fn read(&mut self) -> Result<psd_rig::Reading, psd_rig::RigFault> {
            self.$rig.read()
        }
    };
    (@traverse $rig:tt) => {
        fn traverse(
            &mut self,
            targets: &[f64],
            velocity: f64,
            samples: usize,
            each: psd_rig::EachReading<'_>,
        ) -> Result<(), psd_rig::RigFault> {
            self.$rig.traverse(targets, velocity, samples, each)
        }
    };
    (@follow_paths $rig:tt) => {
        fn follow_paths(
            &mut self,
            paths: &[psd_physics::tracking::trajectory::Path],
            samples: usize,
            each: psd_rig::EachReading<'_>,
        ) -> Result<(), psd_rig::RigFault> {
            self.$rig.follow_paths(paths, samples, each)
        }
    };
    (@hold $rig:tt) => {
        fn hold(&mut self) {
            self.$rig.hold();
        }
    };
    (@halt $rig:tt) => {
        fn halt(&mut self) -> Option<psd_rig::FinalHold> {
            self.$rig.halt()
        }
    };
    (@take_broken $rig:tt) => {
        fn take_broken(&mut self) -> Option<psd_rig::Reading> {
            self.$rig.take_broken()
        }
    };
    (@declared_noise $rig:tt) => {
        fn declared_noise(&self) -> psd_rig::DeclaredNoise {
            self.$rig.declared_noise()
        }
    };
}
