// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/certified_cut.hpp"

#include <algorithm>
#include <cstddef>

namespace tactus::test
{

/// Ratio of the bounds of one cut to the true errors.
///
/// The true error of a cut is the one-sided Hausdorff distance from the source to it, by a raster
/// over every source face. That of a face is the greatest distance to it of the raster points
/// nearest to it. The certificate may assign a point to another face, so the bound of one face can
/// be less than its true error; that of the cut cannot.
struct CertificateFigures
{
    std::size_t faces{0}; ///< Faces of the cut.
    double bound_max_m{0.0};
    double true_max_m{0.0};
    /// Means over the cut's area, without faces that no point is nearest to.
    double bound_mean_m{0.0};
    double true_mean_m{0.0};
    /// Mean over the cut's area of bound / true error. It is large on flat surfaces with sharp
    /// edges: a face may cover a point of the flat beyond an edge, while the points nearest to it
    /// have no error.
    double face_ratio_mean{0.0};
    double flat_m{0.0}; ///< Quarter of a quantum, the least length in a ratio.

    [[nodiscard]] double max_ratio() const { return ratio(bound_max_m, true_max_m); }
    [[nodiscard]] double mean_ratio() const { return ratio(bound_mean_m, true_mean_m); }
    [[nodiscard]] double ratio(double bound_m, double true_m) const
    {
        return std::max(bound_m, flat_m) / std::max(true_m, flat_m);
    }
};

/// Figures of the finest cut of the simplification with at most `faces` faces. Shares no code with
/// the certificate. The raster has about `points` points, and 15 to 153 a source face; about a
/// microsecond each.
[[nodiscard]] CertificateFigures measure_certificate(const PreparedMesh& prepared,
                                                     const Simplification& simplification,
                                                     std::size_t faces,
                                                     std::size_t points = 1'000'000);

} // namespace tactus::test
