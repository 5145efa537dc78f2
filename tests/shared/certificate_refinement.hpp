// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/replay.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/certified_cut.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

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

/// Cut of a file, refined from the base mesh in any order that the dependencies permit.
class ClosedCut
{
public:
    /// Starts at the base mesh. The model must be sound and outlive this object.
    explicit ClosedCut(const DecodedModel& model);

    /// Splits a record and its dependencies. Returns the split records in order, none if it was
    /// already split. Valid until the next call.
    std::span<const RecordId> split_with_closure(RecordId target);

    [[nodiscard]] bool is_split(RecordId record) const { return is_split_[record.value]; }
    [[nodiscard]] std::size_t split_count() const { return split_count_; }
    [[nodiscard]] const Replay& replay() const { return replay_; }

private:
    [[nodiscard]] RecordId missing_dependency(RecordId record) const;

    const DecodedModel& model_;
    Replay replay_;
    std::vector<bool> is_split_;
    std::size_t split_count_{0};
    std::vector<RecordId> open_;
    std::vector<RecordId> taken_;
};

/// Splits from the base mesh until the answer for a point is exact, each the certificate's first
/// choice: the coarse face of least distance - bound, with all that its split depends on. No
/// budgets, pages or tree: the result of a frame's refinement with unlimited time.
class CertificateRefinement
{
public:
    /// Prepares by one pass over the records. The model must outlive this object.
    explicit CertificateRefinement(const DecodedModel& model);

    struct Answer
    {
        double distance_m{0.0}; ///< Distance to the nearest face that was found exact.
        std::vector<RecordId> splits;
    };

    /// Splits until no coarse face can be nearer than the nearest exact one. 20 B a face of the
    /// source, and some microseconds a split.
    [[nodiscard]] Answer find_distance(const Vec3& point_m) const;
    /// Splits until every source face that meets the sphere is active, as for a tool's contact.
    [[nodiscard]] Answer certify_sphere(const Vec3& center_m, double radius_m) const;

private:
    class Run;

    const DecodedModel& model_;
    std::vector<RecordId> first_splits_; ///< First splits by base face.
};

} // namespace tactus::test
