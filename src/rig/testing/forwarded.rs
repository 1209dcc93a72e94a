//! A rig that changes a few methods of another one, for tests. In: the field with the other rig, and the methods that it keeps. Out:
//! those methods.

/// Forwards these methods of [`Rig`](crate::rig::Rig) to the rig in a field.
macro_rules! forwarded {
    ($rig:tt: $($method:ident),+) => {
        $(forwarded!(@$method $rig);)+
    };
    (@identity $rig:tt) => {
        fn identity(&self) -> crate::rig::Identity {
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
        ) -> Result<crate::rig::EncodedMove, crate::rig::RigFault> {
            self.$rig.propose(targets, speed)
        }
    };
    (@execute $rig:tt) => {
        fn execute(&mut self) -> Result<(), crate::rig::RigFault> {
            self.$rig.execute()
        }
    };
    (@pause $rig:tt) => {
        fn pause(&mut self, seconds: f64) -> Result<(), crate::rig::RigFault> {
            self.$rig.pause(seconds)
        }
    };
    (@read $rig:tt) => {
        fn read(&mut self) -> Result<crate::rig::Reading, crate::rig::RigFault> {
            self.$rig.read()
        }
    };
    (@traverse $rig:tt) => {
        fn traverse(
            &mut self,
            targets: &[f64],
            velocity: f64,
            samples: usize,
            each: crate::rig::EachReading<'_>,
        ) -> Result<(), crate::rig::RigFault> {
            self.$rig.traverse(targets, velocity, samples, each)
        }
    };
    (@follow_paths $rig:tt) => {
        fn follow_paths(
            &mut self,
            paths: &[crate::physics::tracking::trajectory::Path],
            samples: usize,
            each: crate::rig::EachReading<'_>,
        ) -> Result<(), crate::rig::RigFault> {
            self.$rig.follow_paths(paths, samples, each)
        }
    };
    (@hold $rig:tt) => {
        fn hold(&mut self) {
            self.$rig.hold();
        }
    };
    (@halt $rig:tt) => {
        fn halt(&mut self) -> Option<crate::rig::FinalHold> {
            self.$rig.halt()
        }
    };
    (@take_broken $rig:tt) => {
        fn take_broken(&mut self) -> Option<crate::rig::Reading> {
            self.$rig.take_broken()
        }
    };
    (@declared_noise $rig:tt) => {
        fn declared_noise(&self) -> crate::rig::DeclaredNoise {
            self.$rig.declared_noise()
        }
    };
}
pub(crate) use forwarded;
