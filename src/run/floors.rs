//! The seam between the floors of a frame and the axes of the rig. The rig may carry a part of the frame; the models of the other storeys
//! are computed here. In: targets of all floors. Out: displacement and restoring force of all floors. Integrators and procedures see
//! floors in numbers of the prototype; guard, rig and run log see the axes in numbers of the rig. If the rig carries the whole frame at
//! full scale, or one degree of freedom, the axes are the floors. In a frame of matrices with elements, the floors are its degrees of
//! freedom, and each tested element has an axis.

use super::hybrid::Hybrid;
use super::session::Session;
use super::stop::Stop;
use super::{AxisReport, StepReport};
use psd_physics::statistics::DeclaredNoise;
use psd_physics::structure::assemblies::{Assemblies, StoreyReadings};
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::substructures::Substructures;
use psd_plan::schema::frames::ELEMENTS;
use psd_plan::uncertainty::NOISE;
use psd_rig::{Reading, RigFault, UnfinishedStep};
use psd_text::units::Dimension;

/// Of the largest deformation: positions of equal elements that differ by less have the same shape.
const SAME_SHAPE: f64 = 0.01;

impl Session<'_> {
    /// The layout of the assemblies; None if the axes are the floors.
    pub(crate) fn assemblies(&self) -> Option<&Assemblies> {
        let hybrid = self.hybrid.as_ref()?;
        Some(hybrid.substructures.assemblies())
    }

    /// The substructures where the last procedure that integrates began; None if the axes are the floors.
    pub(crate) fn substructures_at_start(&self) -> Option<Substructures> {
        self.hybrid.as_ref().map(|hybrid| hybrid.at_start.clone())
    }

    /// The readings of the storeys of a frame.
    pub(crate) fn storey_readings(&self) -> Vec<StoreyReadings> {
        self.readings_with(self.guard.declared_noise())
    }

    /// The same with the resolution q of the forces as a part of their noise: q/√12.
    pub(crate) fn resolved_storey_readings(&self) -> Vec<StoreyReadings> {
        let noise = self.guard.declared_noise();
        let rounding = self.force_resolution / 12_f64.sqrt();
        self.readings_with(DeclaredNoise {
            force: noise.force.hypot(rounding),
            ..noise
        })
    }

    fn readings_with(&self, noise: DeclaredNoise) -> Vec<StoreyReadings> {
        self.assemblies().map_or_else(
            || StoreyReadings::of_floors(noise, self.guard.commanded().len()),
            |assemblies| assemblies.readings(noise),
        )
    }

    /// The noise of one cell and of one transducer, in numbers of the prototype.
    pub(crate) fn floor_noise(&self) -> DeclaredNoise {
        let noise = self.guard.declared_noise();
        self.assemblies()
            .map_or(noise, |assemblies| assemblies.largest_noise(noise))
    }

    /// Standard deviation of the measured base shear \[N\].
    pub(crate) fn base_shear_noise(&self) -> f64 {
        let Some(elements) = self.assemblies().and_then(Assemblies::elements) else {
            return self
                .storey_readings()
                .first()
                .map_or(0.0, StoreyReadings::shear_noise);
        };
        let each = elements.ends.iter().zip(self.element_noise());
        let on_the_ground = each.filter(|(ends, _)| ends.contains(&None));
        on_the_ground.fold(0.0, |all, (_, noise)| noise.hypot(all))
    }

    /// Standard deviation of the measured force of each element of a frame of matrices \[N\]; none without elements.
    pub(crate) fn element_noise(&self) -> Vec<f64> {
        if self.assemblies().and_then(Assemblies::elements).is_none() {
            return Vec::new();
        }
        let readings = self.storey_readings();
        readings.iter().map(StoreyReadings::shear_noise).collect()
    }

    /// Commanded displacements of the floors \[m\], and the reading there. The computed storeys are at rest at zero shear.
    pub(crate) fn floors_at_rest(&mut self) -> Result<(Vec<f64>, Reading), Stop> {
        let commanded = self.guard.commanded().to_vec();
        let reading = self.guard.read()?;
        let Some(hybrid) = &mut self.hybrid else {
            return Ok((commanded, reading));
        };
        hybrid.substructures.rest(&commanded);
        hybrid.at_start = hybrid.substructures.clone();
        hybrid.axes = reading;
        hybrid.commanded = hybrid.floors_at(&commanded).displacement;
        let floors = (hybrid.commanded.clone(), hybrid.floors());
        self.check_shape(&commanded, &floors.0)?;
        Ok(floors)
    }

    /// Tested elements that close a circle have deformations of one shape of the frame only. After an unloading each may stand at its own:
    /// the first step would then move them by the difference.
    fn check_shape(&self, axes: &[f64], floors: &[f64]) -> Result<(), Stop> {
        let Some(elements) = self.assemblies().and_then(Assemblies::elements) else {
            return Ok(());
        };
        let noise = self.floor_noise();
        let softest = elements
            .stiffness
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        let largest = |values: &mut dyn Iterator<Item = f64>| {
            values.fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let shape = self.axes_of(floors);
        let apart = largest(&mut axes.iter().zip(&shape).map(|(axis, shape)| axis - shape));
        let alike = SAME_SHAPE * largest(&mut axes.iter().copied())
            + NOISE * (noise.resolution + noise.force / softest);
        if apart <= alike {
            return Ok(());
        }
        Err(Stop::bad_input(
            ELEMENTS.name,
            apart,
            Dimension::LENGTH,
            "0: by this the first step would move tested elements, so that their deformations are those of one shape of the frame. Let the \
             frame come to rest instead of the unloading before it, or run this test as a separate plan",
        ))
    }

    /// The last reading of the elements of a frame of matrices, in numbers of the prototype; none for any other specimen.
    pub(crate) fn elements_read(&self) -> Vec<ElementReading> {
        self.hybrid.as_ref().map_or_else(Vec::new, Hybrid::elements)
    }

    /// Targets of the axes \[m\], or their velocities \[m/s\], from those of the floors.
    pub(crate) fn axes_of(&self, floors: &[f64]) -> Vec<f64> {
        self.hybrid.as_ref().map_or_else(
            || floors.to_vec(),
            |hybrid| hybrid.substructures.assemblies().axes_of(floors),
        )
    }

    /// The reading of the floors from that of the axes. Where the targets of the floors \[m\] are reached, the computed storeys have moved
    /// there in `seconds` of simulated time.
    pub(crate) fn floors_read(
        &mut self,
        targets: &[f64],
        seconds: f64,
        is_reached: bool,
        axes: Reading,
    ) -> Reading {
        let Some(hybrid) = &mut self.hybrid else {
            return axes;
        };
        if is_reached {
            hybrid.substructures.advance(targets, seconds);
            hybrid.commanded.copy_from_slice(targets);
        }
        hybrid.axes = axes;
        hybrid.floors()
    }

    /// [`Session::step`] of the floors; their simulated motion takes `seconds`.
    pub(crate) fn step_floors(
        &mut self,
        targets: &[f64],
        pause: f64,
        seconds: f64,
        reading: &mut Reading,
    ) -> Result<Option<UnfinishedStep>, Stop> {
        let Some(hybrid) = &mut self.hybrid else {
            return self.step(targets, pause, reading);
        };
        let axes = hybrid.substructures.assemblies().axes_of(targets);
        let mut read = hybrid.axes.clone();
        let ended = self.step(&axes, pause, &mut read)?;
        let is_reached = ended.as_ref().is_none_or(|ended| ended.is_reached);
        *reading = self.floors_read(targets, seconds, is_reached, read);
        Ok(ended)
    }

    /// Moves the floors to these positions \[m\], as [`Session::go_to_all`]. Computed storeys do not move.
    pub(crate) fn floors_go_to(
        &mut self,
        positions: &[f64],
        speed: Option<f64>,
    ) -> Result<(), RigFault> {
        let axes = self.axes_of(positions);
        self.go_to_all(&axes, speed)?;
        if let Some(hybrid) = &mut self.hybrid {
            hybrid.commanded.copy_from_slice(positions);
        }
        Ok(())
    }

    /// The axial axis of a storey, or every one, goes to this force \[N\] while the other axes hold. One reading of the floors follows, and
    /// the fault if a limit was exceeded.
    pub(crate) fn load_axially(
        &mut self,
        storey: Option<usize>,
        force: f64,
    ) -> Result<(Reading, Option<Stop>), Stop> {
        let loaded = self.guard.load_axially(storey, force);
        self.floors_after(loaded)
    }

    /// [`Session::floors_at_rest`] of what is unloaded: of the floors, or of the elements of a frame of matrices. Of elements the rig alone
    /// moves: K and the computed elements do not come to balance with it.
    pub(crate) fn loaded_at_rest(&mut self) -> Result<(Vec<f64>, Reading), Stop> {
        if self.assemblies().and_then(Assemblies::elements).is_none() {
            return self.floors_at_rest();
        }
        let read = self.guard.read()?;
        if let Some(hybrid) = &mut self.hybrid {
            hybrid.substructures.unload();
            hybrid.axes = read.clone();
        }
        Ok((self.loaded_commanded(), self.loaded(read)))
    }

    /// Moves what is unloaded to these displacements \[m\], as [`Session::floors_go_to`].
    pub(crate) fn loaded_go_to(
        &mut self,
        positions: &[f64],
        speed: Option<f64>,
    ) -> Result<(), RigFault> {
        let of_elements = self.assemblies().filter(|of| of.elements().is_some());
        match of_elements.map(|of| of.axes_of_elements(positions.to_vec())) {
            Some(axes) => self.go_to_all(&axes, speed),
            None => self.floors_go_to(positions, speed),
        }
    }

    /// The last targets of what is unloaded \[m\].
    pub(crate) fn loaded_commanded(&self) -> Vec<f64> {
        let hybrid = self.hybrid.as_ref();
        let elements = hybrid.and_then(|hybrid| hybrid.elements_alone(self.guard.commanded()));
        elements.map_or_else(
            || self.floors_commanded().to_vec(),
            |elements| elements.displacement,
        )
    }

    /// [`Session::read_after`] of what is unloaded.
    pub(crate) fn loaded_after(
        &mut self,
        motion: Result<(), RigFault>,
    ) -> Result<(Reading, Option<Stop>), Stop> {
        let (floors, stop) = self.floors_after(motion)?;
        Ok((self.loaded(floors), stop))
    }

    fn loaded(&self, floors: Reading) -> Reading {
        let hybrid = self.hybrid.as_ref();
        let elements = hybrid.and_then(|hybrid| hybrid.elements_alone(&hybrid.axes.displacement));
        elements.unwrap_or(floors)
    }

    /// The last targets of the floors \[m\].
    pub(crate) fn floors_commanded(&self) -> &[f64] {
        self.hybrid
            .as_ref()
            .map_or_else(|| self.guard.commanded(), |hybrid| &hybrid.commanded)
    }

    /// [`Session::read_after`] of the floors.
    pub(crate) fn floors_after(
        &mut self,
        motion: Result<(), RigFault>,
    ) -> Result<(Reading, Option<Stop>), Stop> {
        let (axes, stop) = self.read_after(motion)?;
        let Some(hybrid) = &mut self.hybrid else {
            return Ok((axes, stop));
        };
        hybrid.axes = axes;
        Ok((hybrid.floors(), stop))
    }

    /// The reading of the axes from which the last reading of the floors, `floors`, is.
    pub(crate) fn axes_read<'a>(&'a self, floors: &'a Reading) -> &'a Reading {
        self.hybrid.as_ref().map_or(floors, |hybrid| &hybrid.axes)
    }

    /// The report of a step of the floors becomes that of the axes, with the numbers of the rig. Without any axis it remains.
    pub(crate) fn report_axes(&self, report: &mut StepReport) {
        let Some(hybrid) = &self.hybrid else { return };
        let floors = |value: fn(&AxisReport) -> f64| -> Vec<f64> {
            let floors: Vec<f64> = report.axes.iter().map(value).collect();
            hybrid.substructures.assemblies().axes_of(&floors)
        };
        let command = floors(|floor| floor.command);
        let velocity = floors(|floor| floor.velocity.unwrap_or(0.0));
        let acceleration = floors(|floor| floor.acceleration.unwrap_or(0.0));
        if command.is_empty() {
            return;
        }
        let axis = |axis: usize| AxisReport {
            command: command[axis],
            displacement: hybrid.axes.displacement[axis],
            velocity: Some(velocity[axis]),
            acceleration: Some(acceleration[axis]),
            force: hybrid.axes.force[axis],
        };
        report.axes = (0..command.len()).map(axis).collect();
    }
}
