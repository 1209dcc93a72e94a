//! The list of stable codes. A new diagnostic is one line here and one page in `explain/`.

use super::Severity;

macro_rules! codes {
    ($($code:ident $name:ident $severity:ident;)*) => {
        /// A stable diagnostic code, shown as `E201`. Codes are never reused.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code { $($name),* }

        impl Code {
            /// Every code, in order.
            pub const ALL: &'static [Code] = &[$(Code::$name),*];

            /// The code as it is printed: `E201`.
            #[must_use]
            pub const fn id(self) -> &'static str {
                match self { $(Code::$name => stringify!($code)),* }
            }

            #[must_use]
            pub const fn severity(self) -> Severity {
                match self { $(Code::$name => Severity::$severity),* }
            }
        }
    };
}

codes! {
    // 1: the text
    E101 Syntax Error;
    E102 UnclosedBracket Error;
    E103 BadNumber Error;
    E104 UnitWithoutBlank Error;
    E105 NestedTooDeep Error;
    E106 BadText Error;
    E107 TooLarge Error;
    E108 PlanBlock Error;
    // 2: names
    E201 UnknownBlock Error;
    E202 UnknownField Error;
    E203 UnknownName Error;
    E204 UnknownUnit Error;
    E205 UnknownVariant Error;
    E206 UnknownResult Error;
    E207 UnknownFunction Error;
    E208 Duplicate Error;
    E209 MissingField Error;
    E210 MissingBlock Error;
    E212 BlockName Error;
    E213 BadArgument Error;
    E214 UnknownParameter Error;
    // 3: dimensions and types
    E301 WrongDimension Error;
    E302 MissingUnit Error;
    E303 MismatchedDimensions Error;
    E304 WrongType Error;
    E305 BadExponent Error;
    // 4: values
    E401 OutOfRange Error;
    E402 BadRange Error;
    E403 UsedBeforeItRan Error;
    E404 Cycle Error;
    E405 TooMany Error;
    E406 SettingOutOfRange Error;
    E407 NotFinite Error;
    E408 Edition Error;
    E409 StoreyBendsOtherwise Error;
    // 5: files
    E501 FileNotFound Error;
    E502 BadPath Error;
    E503 UseCycle Error;
    E504 TooManyFiles Error;
    // 6: the test as a whole
    E601 AmbiguousSpecimen Error;
    E602 BeyondLimits Error;
    E603 UnknownRig Error;
    E604 LimitsWider Error;
    E605 SeveralSpecimens Error;
    E606 RealRigIncomplete Error;
    E607 RigLinks Error;
    E608 WrongDevice Error;
    E609 CountsWithoutForce Error;
    E610 BadPort Error;
    E611 PortTwice Error;
    E612 NotADay Error;
    E613 WatchdogTooShort Error;
    E614 FieldWithoutUse Error;
    E615 AxesDiffer Error;
    E616 TooManyAxes Error;
    E617 UnknownColumn Error;
    E618 ToleranceTwice Error;
    E619 NobodyNamed Error;
    E620 GroundRecord Error;
    E621 BadMatrix Error;
    E622 StoreyStiffness Error;
    E623 SpecimenTwice Error;
    E624 NoStoreys Error;
    E625 OneDegreeOfFreedom Error;
    E626 FrameOnRealRig Error;
    E627 DampingRatios Error;
    E628 NoOneStiffness Error;
    E629 DiskSpace Error;
    E630 CornersDoNotFit Error;
    E631 BadTableFile Error;
    E632 BehaviourIncomplete Error;
    E633 UnfitInside Error;
    E634 NoSuchProperty Error;
    E635 TooUncertain Error;
    E636 ChannelsDiffer Error;
    E637 NotAsked Error;
    E638 NeverArrives Error;
    E639 DampingTooUncertain Error;
    E640 WhichStorey Error;
    E641 NoUseOnAFrame Error;
    E642 LawNeedsTangent Error;
    E643 Unstable Error;
    E644 NoPathToFollow Error;
    E645 StopsBetweenReadings Error;
    E646 RateWithoutSpeed Error;
    E647 NoUseWithRate Error;
    E648 ConditionWithoutImpact Error;
    E649 BreaksTwice Error;
    E650 RelaxationWithoutHold Error;
    E651 NotTogether Error;
    E652 NobodyToFreeIt Error;
    E653 TooManyRecordedSteps Error;
    E654 ReadApart Error;
    E655 NeverGiven Error;
    E656 NotAnInput Error;
    E657 BadDistribution Error;
    E658 BadCorrelation Error;
    E659 SamplesFile Error;
    E660 CannotGrow Error;
    E661 VariesNothing Error;
    E662 NoResultRead Error;
    E663 ProbabilityMisplaced Error;
    E664 NothingToDecide Error;
    E665 StudyOnRealRig Error;
    E666 InvalidEnd Error;
    E667 NeverMet Error;
    // 7: plans that run but are not advisable
    W701 StepAboveCritical Warning;
    W702 PeakForceUnderRigidLaw Warning;
    W703 LimitForceNotResolved Warning;
    W704 NothingRequired Warning;
    W705 NothingRuns Warning;
    W706 Unused Warning;
    W707 CalibrationWithoutDay Warning;
    W708 DeviceNotPinned Warning;
    W709 DriftWithinNoise Warning;
    W710 WideTolerance Warning;
    W712 BeyondStability Warning;
    W713 RecordFinerThanStep Warning;
    W711 ResolutionUnknown Warning;
    W714 UncertaintyUnused Warning;
    W715 TableTooShort Warning;
    W716 DampingTwice Warning;
    W717 NotPrinted Warning;
    W718 StifferThanOperator Warning;
    W719 TrackingStops Warning;
    W720 RepeatedImpact Warning;
    W721 LevelsDoNotRise Warning;
    W722 FewDegreesOfFreedom Warning;
    W724 BeyondMechanism Warning;
    W726 FewDecades Warning;
    W728 NoEffect Warning;
    W727 CheckWithinNoise Warning;
    W729 NothingToGuard Warning;
    W730 FinalIsNotResidual Warning;
    W731 TooFewRuns Warning;
    W732 AlwaysMet Warning;
    W733 RunsWithoutResult Warning;
    W734 BandWithinResolution Warning;
    W735 WindowExcludesStiffness Warning;
    W736 PartialUnderGuard Warning;
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}
