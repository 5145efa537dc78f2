// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/replay.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/forest_replay.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::test
{

/// A mesh that stands for a finer one, and what each face claims: that the part of the source for
/// which it stands is within its bound. In metres of the model's frame.
struct CertifiedCut
{
    std::vector<Face> faces;
    std::vector<double> bounds_m; ///< One a face.
};

/// The finest of at most `faces` faces, or the base, that the simplification went through, with
/// bounds as they were proven: not rounded up to the codes of a file. Linear in the source.
[[nodiscard]] CertifiedCut cut_on_the_way(const PreparedMesh& prepared,
                                          const Simplification& simplification, std::size_t faces);

/// What a replay has undone so far, likewise.
[[nodiscard]] CertifiedCut cut_of(const PreparedMesh& prepared, const ForestReplay& replay);
/// What a replay of a file has split so far, with bounds as the file says. Linear in the source.
[[nodiscard]] CertifiedCut cut_of(const DecodedModel& model, const Replay& replay);

/// The same cut with all bounds multiplied.
[[nodiscard]] CertifiedCut with_bounds_times(double factor, CertifiedCut cut);

struct Violation
{
    Vec3 point_m{0.0, 0.0, 0.0};
    double excess_m{0.0}; ///< How much farther than its bound the point is from every face.
};

/// The first of the points of the source that no face's bound covers, by more than `tolerance_m`.
/// What the tree in double precision finds is judged again by brute force in extended precision.
/// Some microseconds a point.
[[nodiscard]] std::optional<Violation>
find_violation(const CertifiedCut& cut, std::span<const Vec3> points_m, double tolerance_m);

} // namespace tactus::test
