// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/surface_query.hpp"
#include "tests/bench/peers/point_query.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::bench
{

/// Pools for all of a scene's model.
[[nodiscard]] std::size_t ample_pool_bytes(const Scene& scene);

/// The least pools in which all of a scene's model fits, within 2 %: what static mode takes.
[[nodiscard]] std::size_t static_pool_bytes(const Scene& scene);

/// A rig with pools for all of a scene's model, refined to the source mesh without a frame; a
/// failure when it can't be. The pools of `options` don't count.
[[nodiscard]] std::unique_ptr<test::FrameRig> refined_rig(const Scene& scene,
                                                          test::RigOptions options = {});

/// A model refined to the source mesh: the tree that every query of a static model sees.
class StaticModel
{
public:
    explicit StaticModel(const Scene& scene) : rig_(refined_rig(scene)) {}

    [[nodiscard]] AbTree& tree() const { return model().tree; }
    [[nodiscard]] Model& model() const { return rig_->model(); }
    /// Of its pools, tables and records included, without the room that nothing is in.
    [[nodiscard]] std::size_t bytes() const
    {
        return required_bytes({&model().header, 1}, {&model().capacities, 1});
    }

private:
    std::unique_ptr<test::FrameRig> rig_;
};

/// The controller's distance query over a static model, as a contestant. One probe: it keeps where
/// the last answer was found.
class TactusQuery final : public TouchQuery
{
public:
    explicit TactusQuery(const AbTree& tree) : tree_(tree) {}

    [[nodiscard]] std::string name() const override { return "Tactus"; }
    /// NaN when the answer is not proven to rounding.
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override;
    [[nodiscard]] Vec3 nearest_m() const override { return nearest_m_; }
    void forget() override { memory_ = {}; }

    /// The last question once more, into scratch memory and by the same machine code: what a loop
    /// does in the wait before its deadline.
    void rehearse();

    /// Of all questions so far.
    [[nodiscard]] std::uint64_t nodes_visited() const { return nodes_visited_; }
    [[nodiscard]] std::uint64_t triangles_tested() const { return triangles_tested_; }

private:
    const AbTree& tree_;
    QueryMemory memory_;
    Vec3 last_point_m_{0.0, 0.0, 0.0};
    double last_band_m_{0.0};
    Vec3 nearest_m_{0.0, 0.0, 0.0};
    double rehearsed_m_{0.0};
    std::uint64_t nodes_visited_{0};
    std::uint64_t triangles_tested_{0};
};

} // namespace tactus::bench
