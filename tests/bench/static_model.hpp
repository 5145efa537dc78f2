// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/query/surface_query.hpp"
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::bench
{

/// Pools for a scene's whole model.
[[nodiscard]] std::size_t ample_pool_bytes(const Scene& scene);

/// Smallest pools that hold a scene's whole model, within 2 %: the memory of static mode.
[[nodiscard]] std::size_t static_pool_bytes(const Scene& scene);

/// Rig with pools for a scene's whole model, refined to the source mesh without a frame; a failure
/// if that is impossible. The pools of `options` are ignored.
[[nodiscard]] std::unique_ptr<test::FrameRig> refined_rig(const Scene& scene,
                                                          test::RigOptions options = {});

/// Model refined to the source mesh: the tree of all static queries.
class StaticModel
{
public:
    explicit StaticModel(const Scene& scene) : rig_(refined_rig(scene)) {}

    [[nodiscard]] AbTree& tree() const { return model().tree; }
    [[nodiscard]] Model& model() const { return rig_->model(); }
    /// Bytes in use of its pools, tables and records included.
    [[nodiscard]] std::size_t bytes() const
    {
        return required_bytes({&model().header, 1}, {&model().capacities, 1});
    }

private:
    std::unique_ptr<test::FrameRig> rig_;
};

/// Distance query over a static model, as a contestant with one sphere. It remembers the place of
/// the last answer.
class TactusQuery final : public TouchQuery
{
public:
    explicit TactusQuery(const AbTree& tree) : tree_(tree) {}

    [[nodiscard]] std::string name() const override { return "Tactus"; }
    /// NaN when the answer is not proven to rounding.
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override;
    [[nodiscard]] Vec3 nearest_m() const override { return nearest_m_; }
    void forget() override { memory_ = {}; }

    /// Repeats the last question into scratch memory with the same machine code, as a loop does in
    /// the wait before its deadline.
    void warm_caches();

    /// Counts over all questions so far.
    [[nodiscard]] std::uint64_t nodes_visited() const { return nodes_visited_; }
    [[nodiscard]] std::uint64_t triangles_tested() const { return triangles_tested_; }

private:
    const AbTree& tree_;
    QueryMemory memory_;
    Vec3 last_point_m_{0.0, 0.0, 0.0};
    double last_band_m_{0.0};
    Vec3 nearest_m_{0.0, 0.0, 0.0};
    double warmed_m_{0.0};
    std::uint64_t nodes_visited_{0};
    std::uint64_t triangles_tested_{0};
};

} // namespace tactus::bench
