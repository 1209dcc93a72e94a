//! The device that moves each axis of a real rig, and the device that measures its force. In: the links of a rig and of its axes. Out:
//! every device once, with its axes. It does not depend on the protocol.

use crate::{AxisPlan, DeviceLink, RealLink};

/// A device with its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Behind<'a> {
    pub link: &'a DeviceLink,
    /// Indices of the axes; the channels of the device are in this order.
    pub axes: Vec<usize>,
    /// Whether it belongs to one axis: the axis declares it, not the rig.
    pub own: bool,
}

impl Behind<'_> {
    /// The name of the device among those of its role: `load cell`, or `load cell of axis 2`.
    #[must_use]
    pub fn name(&self, role: &str) -> String {
        match self.axes.first() {
            Some(axis) if self.own => format!("{role} of axis {}", axis + 1),
            _ => role.to_owned(),
        }
    }
}

impl RealLink {
    /// The actuators: the rig's own first, with every axis that declares none.
    #[must_use]
    pub fn actuators(&self) -> Vec<Behind<'_>> {
        self.behind(Some(&self.actuator), |axis| axis.actuator.as_ref())
    }

    /// The load cells that are devices apart from the actuator.
    #[must_use]
    pub fn load_cells(&self) -> Vec<Behind<'_>> {
        self.behind(self.load_cell.as_ref(), |axis| axis.load_cell.as_ref())
    }

    /// Every device with its name, the actuators first.
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

    /// Number of axes that are not axial. Those are the last ones.
    #[must_use]
    pub fn lateral_axes(&self) -> usize {
        let lateral = self.axes.iter().take_while(|axis| axis.axial.is_none());
        lateral.count().max(1)
    }

    /// The device that moves the axis with this index.
    #[must_use]
    pub fn moved_by(&self, axis: usize) -> &DeviceLink {
        self.axes
            .get(axis)
            .and_then(|own| own.actuator.as_ref())
            .unwrap_or(&self.actuator)
    }

    /// The device that measures the force of the axis with this index, and the index of its channel.
    #[must_use]
    pub fn load_cell_of(&self, axis: usize) -> (&DeviceLink, usize) {
        let among = |behind: Vec<Behind<'_>>| {
            behind.iter().find_map(|behind| {
                behind
                    .axes
                    .iter()
                    .position(|axis_index| *axis_index == axis)
            })
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
