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

/// Coarse mesh with the bound of each face: the part of the source that the face represents is
/// within it. In metres of the model frame.
struct CertifiedCut
{
    std::vector<Face> faces;
    std::vector<double> bounds_m; ///< Bounds, one for each face.
};

/// Finest cut of the simplification with at most `faces` faces, or the base, with bounds as proven,
/// not rounded up to the codes of a file. Linear in the source.
[[nodiscard]] CertifiedCut cut_on_the_way(const PreparedMesh& prepared,
                                          const Simplification& simplification, std::size_t faces);

/// Cut of the collapses that a replay has undone, with bounds as proven.
[[nodiscard]] CertifiedCut cut_of(const PreparedMesh& prepared, const ForestReplay& replay);
/// Cut of the records that a replay of a file has split, with the file's bounds. Linear in the
/// source.
[[nodiscard]] CertifiedCut cut_of(const DecodedModel& model, const Replay& replay);

/// The same cut with scaled bounds.
[[nodiscard]] CertifiedCut with_bounds_times(double factor, CertifiedCut cut);

struct Violation
{
    Vec3 point_m{0.0, 0.0, 0.0};
    double excess_m{0.0}; ///< Distance of the point beyond the bound of every face.
};

/// First source point that no face's bound covers, by more than `tolerance_m`. Points found by the
/// tree in double precision are checked by brute force in extended precision. Some microseconds a
/// point.
[[nodiscard]] std::optional<Violation>
find_violation(const CertifiedCut& cut, std::span<const Vec3> points_m, double tolerance_m);

} // namespace tactus::test
