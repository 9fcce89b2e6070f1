//! The parameters of the virtual robot.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// What the virtual robot has beyond its nominal model, and its controller.
///
/// None of the values was identified. They were chosen so that runs spread as on the real LWA 4P
/// do, or are typical of such arms, as their comments state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VirtualRobotParameters {
    /// Masses, first moments and inertias of the links over the nominal ones \[-\]. Default 1.02:
    /// an identified model is off by a few per cent; the paper's two fits of gravity differ by 10.
    pub link_ratio: f64,
    /// Inertias of the motors over the nominal ones \[-\]. Default 1.03, as for the links.
    pub motor_ratio: f64,
    /// Mass of a payload that the nominal model lacks, fixed to the last link \[kg\]. Default 0.1:
    /// a small tool.
    pub payload_mass: f64,
    /// Position of the payload in the frame of the last link \[m\]. Default 3 cm beyond the flange,
    /// 2 cm beside the axis.
    pub payload_position: [f64; 3],
    /// Breakaway friction minus Coulomb friction, over Coulomb friction without load \[-\]: the
    /// Stribeck effect at standstill. Default 0.1: harmonic drives of this size show 5 to 30 %.
    pub breakaway_ratio: f64,
    /// Speed over which that excess falls to 1/e \[rad/s\]. Default 0.05, a usual order of size.
    pub stribeck_speed: f64,
    /// Temperature at which friction is nominal \[°C\]. Default 32: between cold and warm.
    pub nominal_temperature: f64,
    /// Rate by which Coulomb friction falls with temperature \[1/K\]: its factor is e^(-rate ΔT).
    /// Default 0.006, so that runs spread as on the real robot.
    pub coulomb_rate: f64,
    /// Rate by which viscous friction falls with temperature \[1/K\]. Default 0.012: lubricants
    /// change more than dry contacts.
    pub viscous_rate: f64,
    /// Temperature of the surroundings, and of a cold arm \[°C\]. Default 22.
    pub ambient_temperature: f64,
    /// Heat capacity of what warms up at a joint, over its nominal friction torque at 1 rad/s
    /// \[J/(K N m)\]. Default 1: the gear and its lubricant, not the housing, so that a run
    /// warms a joint by some kelvin, as the drift of the real recordings suggests.
    pub heat_capacity: f64,
    /// Time constant with which a joint cools \[s\]. Default 80.
    pub cooling_time: f64,
    /// Pause between two runs, after the arm has moved back \[s\]. Default 10.
    pub pause: f64,
    /// Amplitude of the torque ripple over the motor torque \[-\]; its period is one motor turn.
    /// Default 0.05. A joint without gear ratio has none.
    pub ripple_ratio: f64,
    /// Resolution of the position encoders \[rad\]. Default 2π/2¹⁷: 17 bits per turn.
    pub encoder_step: f64,
    /// Time constant of the low-pass filter that turns differences of encoder positions into the
    /// velocity \[s\]. Default 0.01.
    pub velocity_filter_time: f64,
    /// Time from a measurement until its torque acts, in controller cycles \[-\], whole or not.
    /// Default 1: the torque of one cycle acts from the start of the next.
    pub delay_cycles: f64,
    /// Planned speed at which the compensation of Coulomb friction reaches tanh(1) of its value
    /// \[rad/s\]. Default 0.015: below it, joints that turn or come to rest stick.
    pub compensation_speed: f64,
    /// Natural frequency of the position error under computed-torque control \[rad/s\]. Default
    /// 15: stable with the default delay and filter.
    pub natural_frequency: f64,
    /// Damping ratio of the position error under computed-torque control \[-\]. Default 1.
    pub damping_ratio: f64,
    /// Largest deviation of a run's start from the planned position \[rad\]. Default 1.5e-3; the
    /// paper's X0 has 1.7e-3 to 7.5e-3.
    pub position_scatter: f64,
    /// Largest deviation of a run's start from the planned velocity \[rad/s\]. Default 0.015, half
    /// of the smaller entries of the paper's X0.
    pub velocity_scatter: f64,
}

impl Default for VirtualRobotParameters {
    fn default() -> Self {
        Self {
            link_ratio: 1.02,
            motor_ratio: 1.03,
            payload_mass: 0.1,
            payload_position: [0.02, 0.0, 0.03],
            breakaway_ratio: 0.1,
            stribeck_speed: 0.05,
            nominal_temperature: 32.0,
            coulomb_rate: 0.006,
            viscous_rate: 0.012,
            ambient_temperature: 22.0,
            heat_capacity: 1.0,
            cooling_time: 80.0,
            pause: 10.0,
            ripple_ratio: 0.05,
            encoder_step: std::f64::consts::TAU / 131_072.0,
            velocity_filter_time: 0.01,
            delay_cycles: 1.0,
            compensation_speed: 0.015,
            natural_frequency: 15.0,
            damping_ratio: 1.0,
            position_scatter: 1.5e-3,
            velocity_scatter: 0.015,
        }
    }
}

/// Longest delay \[cycles\].
const LONGEST_DELAY: f64 = 100.0;

impl VirtualRobotParameters {
    /// Returns the parameters of a robot that is its nominal model: friction without excess and
    /// independent of temperature, no ripple, no delay, no scatter. Its encoders and filter remain.
    #[cfg(test)]
    pub(crate) fn ideal() -> Self {
        Self {
            link_ratio: 1.0,
            motor_ratio: 1.0,
            payload_mass: 0.0,
            breakaway_ratio: 0.0,
            coulomb_rate: 0.0,
            viscous_rate: 0.0,
            ripple_ratio: 0.0,
            delay_cycles: 0.0,
            position_scatter: 0.0,
            velocity_scatter: 0.0,
            ..Self::default()
        }
    }

    /// Checks that each parameter is in its range.
    ///
    /// # Errors
    ///
    /// [`Error::Parameter`] names the first parameter that is not.
    pub(crate) fn validate(&self) -> Result<()> {
        let most = f64::MAX;
        let least = f64::MIN_POSITIVE;
        let [px, py, pz] = self.payload_position;
        let ranges: [(&'static str, f64, f64, f64); 24] = [
            ("link_ratio", self.link_ratio, least, most),
            ("motor_ratio", self.motor_ratio, least, most),
            ("payload_mass", self.payload_mass, 0.0, most),
            ("payload_position[0]", px, -most, most),
            ("payload_position[1]", py, -most, most),
            ("payload_position[2]", pz, -most, most),
            ("breakaway_ratio", self.breakaway_ratio, 0.0, most),
            ("stribeck_speed", self.stribeck_speed, least, most),
            ("nominal_temperature", self.nominal_temperature, -100.0, 250.0),
            ("coulomb_rate", self.coulomb_rate, -1.0, 1.0),
            ("viscous_rate", self.viscous_rate, -1.0, 1.0),
            ("ambient_temperature", self.ambient_temperature, -100.0, 250.0),
            ("heat_capacity", self.heat_capacity, least, most),
            ("cooling_time", self.cooling_time, least, most),
            ("pause", self.pause, 0.0, most),
            ("ripple_ratio", self.ripple_ratio, 0.0, 1.0),
            ("encoder_step", self.encoder_step, least, most),
            ("velocity_filter_time", self.velocity_filter_time, least, most),
            ("delay_cycles", self.delay_cycles, 0.0, LONGEST_DELAY),
            ("compensation_speed", self.compensation_speed, least, most),
            ("natural_frequency", self.natural_frequency, 0.0, most),
            ("damping_ratio", self.damping_ratio, 0.0, most),
            ("position_scatter", self.position_scatter, 0.0, most),
            ("velocity_scatter", self.velocity_scatter, 0.0, most),
        ];
        let outside = ranges.iter().find(|(_, x, low, high)| !(low..=high).contains(&x));
        outside.map_or(Ok(()), |&(name, given, low, high)| {
            Err(Error::Parameter { name, given, low, high })
        })
    }
}
