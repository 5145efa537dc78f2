// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/frame_input.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/test_model.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace tactus::test
{

/// A straight way that shares a point with a face. In the model's frame.
struct Crossing
{
    Vec3 from_m{0.0, 0.0, 0.0};
    Vec3 to_m{0.0, 0.0, 0.0};
    std::uint32_t face{0};

    [[nodiscard]] std::string text() const;
};

/// Of the faces of a mesh, all at full resolution, one that the straight way between two places
/// meets, by exact arithmetic: faces with their borders, ways with their ends. So nothing slips
/// through an edge or a corner, and a way that only touches counts as well. A face without an area
/// is a segment and can be met.
[[nodiscard]] std::optional<Crossing> find_crossing(const TestModel& model, const FaceTree& tree,
                                                    const Vec3& from_m, const Vec3& to_m);

/// The way of one proxy as one object sees it, from frame to frame: from where it stayed last, when
/// the object stood elsewhere, to where the object's new pose has it, and on along the frame's
/// path. Shares no code with the proxy.
class ProxyTrail
{
public:
    /// Both must outlive the trail.
    ProxyTrail(const TestModel& model, const FaceTree& tree) : model_(&model), tree_(&tree) {}

    struct Crossings
    {
        std::optional<Crossing> carried; ///< While the object moved.
        std::optional<Crossing> moved;   ///< By the proxy's own steps.
    };

    /// The next frame, with the path in the world.
    [[nodiscard]] Crossings follow(std::span<const Vec3> path_m, const ObjectPose& pose);

private:
    const TestModel* model_;
    const FaceTree* tree_;
    std::optional<Vec3> last_m_; ///< In the model's frame.
};

} // namespace tactus::test
