//! Which device moves which axis of a real rig, and which one weighs it. In: the links of a rig and of its axes. Out: every
//! device once, with the axes behind it. It knows no dialect.

use crate::plan::{AxisPlan, DeviceLink, RealLink};

/// A device with the axes behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Behind<'a> {
    pub link: &'a DeviceLink,
    /// By their places; its channels are theirs in this order.
    pub axes: Vec<usize>,
    /// It is one axis's own: the axis says it, not the rig.
    pub own: bool,
}

impl Behind<'_> {
    /// As it is called among those of its role: `load cell`, or `load cell of axis 2`.
    #[must_use]
    pub fn name(&self, role: &str) -> String {
        match self.axes.first() {
            Some(axis) if self.own => format!("{role} of axis {}", axis + 1),
            _ => role.to_owned(),
        }
    }
}

impl RealLink {
    /// What moves: the rig's own first, with every axis that has none of its own.
    #[must_use]
    pub fn actuators(&self) -> Vec<Behind<'_>> {
        self.behind(Some(&self.actuator), |axis| axis.actuator.as_ref())
    }

    /// What weighs, where that is not the device that moves.
    #[must_use]
    pub fn load_cells(&self) -> Vec<Behind<'_>> {
        self.behind(self.load_cell.as_ref(), |axis| axis.load_cell.as_ref())
    }

    /// Every device with what it is called, those that move first.
    #[must_use]
    pub fn devices(&self) -> Vec<(String, &DeviceLink)> {
        let actuators = self
            .actuators()
            .into_iter()
            .map(|behind| (behind.name("actuator"), behind.link));
        actuators
            .chain(
                self.load_cells()
                    .into_iter()
                    .map(|behind| (behind.name("load cell"), behind.link)),
            )
            .collect()
    }

    /// The device that moves the axis at this place.
    #[must_use]
    pub fn moved_by(&self, axis: usize) -> &DeviceLink {
        self.axes
            .get(axis)
            .and_then(|own| own.actuator.as_ref())
            .unwrap_or(&self.actuator)
    }

    /// The device that weighs the axis at this place, and which of its channels that is.
    #[must_use]
    pub fn weighed_by(&self, axis: usize) -> (&DeviceLink, usize) {
        let among = |behind: Vec<Behind<'_>>| {
            behind
                .iter()
                .find_map(|behind| behind.axes.iter().position(|place| *place == axis))
        };
        let own = self.axes.get(axis).and_then(|own| own.load_cell.as_ref());
        match own.or(self.load_cell.as_ref()) {
            Some(cell) => (cell, among(self.load_cells()).unwrap_or(0)),
            None => (self.moved_by(axis), among(self.actuators()).unwrap_or(0)),
        }
    }

    fn behind<'a>(
        &'a self,
        shared: Option<&'a DeviceLink>,
        own: fn(&AxisPlan) -> Option<&DeviceLink>,
    ) -> Vec<Behind<'a>> {
        let own = |axis: usize| self.axes.get(axis).and_then(own);
        let (apart, together): (Vec<usize>, Vec<usize>) =
            (0..self.axes.len().max(1)).partition(|axis| own(*axis).is_some());
        let shared = shared.filter(|_| !together.is_empty()).map(|link| Behind {
            link,
            axes: together,
            own: false,
        });
        let apart = apart.into_iter().filter_map(|axis| {
            Some(Behind {
                link: own(axis)?,
                axes: vec![axis],
                own: true,
            })
        });
        shared.into_iter().chain(apart).collect()
    }
}
