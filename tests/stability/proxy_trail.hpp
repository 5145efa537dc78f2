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

/// Straight path that shares a point with a face, in the model frame.
struct Crossing
{
    Vec3 from_m{0.0, 0.0, 0.0};
    Vec3 to_m{0.0, 0.0, 0.0};
    std::uint32_t face{0};

    [[nodiscard]] std::string text() const;
};

/// A face of the full mesh that the straight path between two places meets, by exact arithmetic:
/// faces include their borders, paths their ends. Nothing slips through an edge or a corner, and a
/// path that only touches counts too. A face without an area is a segment and can be met.
[[nodiscard]] std::optional<Crossing> find_crossing(const TestModel& model, const FaceTree& tree,
                                                    const Vec3& from_m, const Vec3& to_m);

/// Path of one proxy relative to one object, from frame to frame: from the last place under the
/// object's old pose, to the same under the new pose, and on along the frame's path. Shares no code
/// with the proxy.
class ProxyTrail
{
public:
    /// Starts without a place. Both arguments must outlive the trail.
    ProxyTrail(const TestModel& model, const FaceTree& tree) : model_(&model), tree_(&tree) {}

    struct Crossings
    {
        std::optional<Crossing> carried; ///< Crossing by the object's motion.
        std::optional<Crossing> moved;   ///< Crossing by the proxy's own steps.
    };

    /// Crossings of the next frame, with the path in the world.
    [[nodiscard]] Crossings follow(std::span<const Vec3> path_m, const ObjectPose& pose);

private:
    const TestModel* model_;
    const FaceTree* tree_;
    std::optional<Vec3> last_m_; ///< Last place in the model frame.
};

} // namespace tactus::test
