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

/// Absorption of a component that cannot shrink further, a triangle or a tetrahedron, into the edge
/// (x, y) of another one: a tetrahedron becomes two faces back to back, two of its three vertices
/// move onto x and y by pair contraction, and then x moves onto the third, d, which takes the faces
/// with it:
///
///          d                     d
///         / \                  / |                  the ring
///        s---t      ->        y--x         ->     y--d  round x
///        y---x  (another)                           is round d
///
/// Each step is a collapse of the common form, and afterwards the rest is manifold as before. In
/// between the component is attached to the edge. d is its vertex nearest to x.
struct Absorption
{
    static constexpr std::size_t kStepsMax = 4;

    StaticVector<Star, kStepsMax>
        steps; ///< Steps; the last one is x -> d, and a tetrahedron's first is extra.
};

struct AbsorptionPlan
{
    std::vector<Absorption> absorptions; ///< Absorptions without a common face, cheapest first.
    /// Cost of the cheapest one that was not chosen, in quanta^4.
    double cost_left{std::numeric_limits<double>::infinity()};
};

/// Plans absorptions up to a cost, which is comparable with a Candidate's, until together they
/// remove `faces_wanted` faces. Reads the present mesh. The same for any number of threads. Costs a
/// search tree over the vertices.
[[nodiscard]] AbsorptionPlan plan_absorptions(const QuantisedMesh& mesh,
                                              const CollapseMesh& current, std::size_t faces_wanted,
                                              double cost_max, unsigned threads);

/// Number of faces in components that cannot shrink further.
[[nodiscard]] std::size_t count_stuck_faces(const CollapseMesh& current);

[[nodiscard]] std::size_t count_components(const CollapseMesh& current);

} // namespace tactus
