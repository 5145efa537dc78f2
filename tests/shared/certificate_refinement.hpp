// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "rt_core/math/vec3.hpp"

#include <vector>

namespace tactus::test
{

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
