// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What a device is and may be asked for when it turns, about the tool's point: as DeviceLimits,
/// for angles. The default is a device that doesn't turn. All values are finite and not negative.
/// Where it makes a torque it measures its rotation, and inertia, slew and stiffness are above
/// zero.
struct TurnLimits
{
    bool is_measured{false};   ///< Its samples have a rotation.
    double torque_max_nm{0.0}; ///< Norm. 0: it makes no torque; what is below tells what it is.
    double inertia_kg_m2{0.0}; ///< Moving, without the hand; about any axis.
    double damping_nm_s_per_rad{0.0};
    double friction_nm{0.0};
    double quantum_rad{0.0};
    double slew_max_nm_per_s{0.0};
    double stiffness_max_nm_per_rad{0.0};
    double added_damping_max_nm_s_per_rad{0.0};

    [[nodiscard]] bool operator==(const TurnLimits&) const = default;
};

/// What a device is and may be asked for, as far as stability depends on it; fixed while it runs.
/// SI, at the tool's tip, the least favourable place and direction of the workspace. All values are
/// finite and not negative; mass, force_max_n, slew_max_n_per_s and stiffness_max_n_per_m are
/// greater than zero. A ForceConditioner asserts it; this library's devices refuse other values
/// when they are made.
struct DeviceLimits
{
    double mass_kg{0.1}; ///< Moving mass without the hand.
    /// Viscous, of the mechanism itself, never of the hand: the hand may let go.
    double damping_n_s_per_m{1.0};
    /// Coulomb friction of the mechanism. 0: not known; then quantisation limits no stiffness, and
    /// a wall may hum within the bound of docs/stability.md.
    double friction_n{0.0};
    double quantum_m{0.0}; ///< Step of the measured position. 0: too small to count.
    /// From the reading of a position to the force that it causes, beyond the period for which a
    /// force is held: computing time, wires, amplifier.
    double delay_s{0.0};
    double force_max_n{8.0};              ///< Norm.
    double slew_max_n_per_s{20'000.0};    ///< How fast the force's norm may grow.
    double stiffness_max_n_per_m{3000.0}; ///< Of any wall, at any rate, by its maker.
    /// Largest damping that the passivity controller may add, in N s/m.
    double added_damping_max_n_s_per_m{5.0};
    TurnLimits turn{};

    [[nodiscard]] bool operator==(const DeviceLimits&) const = default;
};

} // namespace tactus
