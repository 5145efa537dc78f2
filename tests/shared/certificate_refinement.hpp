// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "rt_core/math/vec3.hpp"

#include <vector>

namespace tactus::test
{

/// What a point asks of a file, and which splits from the base mesh up it takes until the answer is
/// exact, if each is what the certificate asks for first: the coarse face whose distance - bound is
/// least, with all that its split depends on. No budgets, no pages, no tree: what the refinement of
/// a frame comes to when it is given time.
class CertificateRefinement
{
public:
    /// The model must outlive it. One pass over the records.
    explicit CertificateRefinement(const DecodedModel& model);

    struct Answer
    {
        double distance_m{0.0};       ///< To the nearest face that was found exact.
        std::vector<RecordId> splits; ///< In their order.
    };

    /// Until no coarse face can be nearer than the nearest exact one. 20 B a face of the source,
    /// and some microseconds a split.
    [[nodiscard]] Answer find_distance(const Vec3& point_m) const;
    /// Until every source face that meets the ball is there: what a tool's contact takes.
    [[nodiscard]] Answer certify_ball(const Vec3& center_m, double radius_m) const;

private:
    class Run;

    const DecodedModel& model_;
    std::vector<RecordId> first_splits_; ///< By base face.
};

} // namespace tactus::test
