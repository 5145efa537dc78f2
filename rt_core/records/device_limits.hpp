// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Rotational properties and limits of a device about the tool's position: DeviceLimits for angles.
/// All values must be finite and not negative. If torque_max_nm > 0, is_measured must be true, and
/// inertia, slew and stiffness must be above zero. The default is a device without rotation.
struct RotationLimits
{
    bool is_measured{false}; ///< Samples contain a rotation.
    /// Largest norm of the torque. 0: the device produces none, but the values below still hold.
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
    /// wall may hum within the bound of docs/internals/passivity.md.
    double friction_n{0.0};
    double quantum_m{0.0}; ///< Step of the measured position. 0: negligible.
    /// Delay from the reading of a position to the force that it causes, in addition to the period
    /// for which a force is held: computing time, wires, amplifier.
    double delay_s{0.0};
    double force_max_n{8.0};              ///< Largest norm of the force.
    double slew_max_n_per_s{20'000.0};    ///< Largest growth of the force's norm.
    double stiffness_max_n_per_m{3000.0}; ///< Limit of the device's maker for any wall and rate.
    /// Largest damping that the passivity controller may add, in N s/m.
    double added_damping_max_n_s_per_m{5.0};
    RotationLimits rotation{};

    [[nodiscard]] bool operator==(const DeviceLimits&) const = default;
};

} // namespace tactus
