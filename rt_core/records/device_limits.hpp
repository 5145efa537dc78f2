// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// What a device is and may be asked for, as far as stability depends on it; fixed while it runs.
/// SI, at the tool's tip, the least favourable place and direction of the workspace. All values are
/// finite and not negative; mass, force_max_n, slew_max_n_per_s and stiffness_max_n_per_m are
/// greater than zero. find_fault() in force/stiffness_rule.hpp says what is wrong.
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
};

} // namespace tactus
