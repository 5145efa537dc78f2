// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace tactus
{

/// Absorption of a component that cannot shrink further into an edge (x, y) of another component.
/// The component is one face, two faces back to back, or a tetrahedron, which first becomes two
/// faces back to back. Its vertices t and s move onto x and y by pair contraction. Then x moves
/// onto the remaining vertex d, which takes over the faces of x:
///
///          d                     d
///         / \                  / |                  the ring
///        s---t      ->        y--x         ->     y--d  round x
///        y---x  (another)                           is round d
///
/// Each step has the form of a Collapse. The mesh is manifold before the first step and after the
/// last. d is the component's vertex nearest to x.
struct Absorption
{
    static constexpr std::size_t kStepsMax = 4;

    StaticVector<Star, kStepsMax>
        steps; ///< Steps in order: the flattening (tetrahedron only), t -> x, s -> y, x -> d.
};

/// Absorptions that can be made together.
struct AbsorptionPlan
{
    std::vector<Absorption> absorptions; ///< Absorptions that share no face, cheapest first.
    /// Cost, in quanta^4, of the absorption at which the choice ended; infinite if all were
    /// considered.
    double cost_left{std::numeric_limits<double>::infinity()};
};

/// Chooses absorptions that cost at most `cost_max`, in quanta^4 as for a Candidate, until together
/// they remove `faces_wanted` faces. `current` is only read. The result does not depend on
/// `threads`. Builds a search tree over the vertices.
[[nodiscard]] AbsorptionPlan plan_absorptions(const QuantisedMesh& mesh,
                                              const CollapseMesh& current, std::size_t faces_wanted,
                                              double cost_max, unsigned threads);

/// Number of present faces in components that cannot shrink further: see Absorption.
[[nodiscard]] std::size_t count_stuck_faces(const CollapseMesh& current);

[[nodiscard]] std::size_t count_components(const CollapseMesh& current);

} // namespace tactus
