// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Rotational properties and limits of a device, about the tool's point: DeviceLimits for angles.
/// The default is a device without rotation. All values are finite and not negative. A device that
/// produces torques measures its rotation, and its inertia, slew and stiffness are above zero.
struct RotationLimits
{
    bool is_measured{false}; ///< Samples contain a rotation.
    /// Norm. 0: the device produces no torque; the values below describe it all the same.
    double torque_max_nm{0.0};
    double inertia_kg_m2{0.0}; ///< Moving inertia about any axis, without the user's hand.
    double damping_nm_s_per_rad{0.0};
    double friction_nm{0.0};
    double quantum_rad{0.0};
    double slew_max_nm_per_s{0.0};
    double stiffness_max_nm_per_rad{0.0};
    double added_damping_max_nm_s_per_rad{0.0};

    [[nodiscard]] bool operator==(const RotationLimits&) const = default;
};

/// Properties and limits of a device on which stability depends; fixed while it runs. SI, at the
/// tool's tip, at the least favourable place and in the least favourable direction of the
/// workspace. All values are finite and not negative; mass, force_max_n, slew_max_n_per_s and
/// stiffness_max_n_per_m are greater than zero. A ForceConditioner asserts that; this library's
/// devices refuse other values at construction.
struct DeviceLimits
{
    double mass_kg{0.1}; ///< Moving mass, without the user's hand.
    /// Viscous damping of the mechanism alone, never of the hand: the user may let go.
    double damping_n_s_per_m{1.0};
    /// Coulomb friction of the mechanism. 0: unknown; quantisation then limits no stiffness, and a
    /// wall may hum within the bound of docs/stability.md.
    double friction_n{0.0};
    double quantum_m{0.0}; ///< Step of the measured position. 0: negligible.
    /// Delay from the reading of a position to the force that it causes, in addition to the period
    /// for which a force is held: computing time, wires, amplifier.
    double delay_s{0.0};
    double force_max_n{8.0};              ///< Norm.
    double slew_max_n_per_s{20'000.0};    ///< Largest growth of the force's norm.
    double stiffness_max_n_per_m{3000.0}; ///< The maker's limit for any wall at any rate.
    /// Largest damping that the passivity controller may add, in N s/m.
    double added_damping_max_n_s_per_m{5.0};
    RotationLimits rotation{};

    [[nodiscard]] bool operator==(const DeviceLimits&) const = default;
};

} // namespace tactus
