// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/certified_cut.hpp"

#include <algorithm>
#include <cstddef>

namespace tactus::test
{

/// How much larger the bounds of one cut are than what they bound.
///
/// The true error of a cut is the one-sided Hausdorff distance from the source to it, by a raster
/// over every source face. That of a face is the largest distance to it of the raster's points
/// that are nearer to it than to any other face. The certificate may assign a point to another
/// face, so the bound of one face can be less than its true error; that of the cut cannot.
struct CertificateFigures
{
    std::size_t faces{0}; ///< Of the cut.
    double bound_max_m{0.0};
    double true_max_m{0.0};
    /// Means over the cut's area, of faces that no point is nearest to left out.
    double bound_mean_m{0.0};
    double true_mean_m{0.0};
    /// Mean over the cut's area of bound / true error. On flat surfaces with sharp edges it is
    /// large: a face may have to answer for a point of the flat beyond an edge, while the points
    /// nearest to it have no error at all.
    double face_ratio_mean{0.0};
    double flat_m{0.0}; ///< A quarter of a quantum: for a ratio no length counts as less.

    [[nodiscard]] double max_ratio() const { return ratio(bound_max_m, true_max_m); }
    [[nodiscard]] double mean_ratio() const { return ratio(bound_mean_m, true_mean_m); }
    [[nodiscard]] double ratio(double bound_m, double true_m) const
    {
        return std::max(bound_m, flat_m) / std::max(true_m, flat_m);
    }
};

/// The figures of the finest cut with at most `faces` faces that the simplification went through.
/// Shares no code with the certificate. The raster has about `points` points, and 15 to 153 a
/// source face; each takes about a microsecond.
[[nodiscard]] CertificateFigures measure_certificate(const PreparedMesh& prepared,
                                                     const Simplification& simplification,
                                                     std::size_t faces,
                                                     std::size_t points = 1'000'000);

} // namespace tactus::test
