// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/query/surface_query.hpp"
#include "tests/bench/peers/point_query.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/frame_rig.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::bench
{

/// A rig with pools for all of a scene's model.
[[nodiscard]] test::RigOptions room_for_all(const Scene& scene);

/// The least pools in which all of a scene's model fits, within 2 %: what static mode takes.
[[nodiscard]] std::size_t static_pool_bytes(const Scene& scene);

/// Splits every record of a model whose chunks are all there. False when one can't be split or the
/// tree has no room.
[[nodiscard]] bool refine_fully(Model& model);

/// A model whose pools hold all of it, refined to the source mesh: the tree that every query of a
/// static model sees.
class StaticModel
{
public:
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, SceneError> make(const Scene& scene);

    [[nodiscard]] AbTree& tree() { return rig_.model().tree; }
    [[nodiscard]] Model& model() { return rig_.model(); }
    /// Of its pools, tables and records included, without the room that nothing is in.
    [[nodiscard]] std::size_t bytes();

private:
    explicit StaticModel(const Scene& scene);

    test::FrameRig rig_;
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
