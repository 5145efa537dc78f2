// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/records/prediction.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

// Any thread: Frame::start() reads it on the one that calls it. No call waits or allocates.
namespace tactus
{

/// One model: bytes of its header and base mesh, and its pool sizes.
struct ModelSource
{
    std::span<const std::byte> header; ///< Copied. Hashes are not verified.
    /// Coded; read once. Empty, where there is room for guests: the model is one, which comes when
    /// a tool is near and goes again.
    std::span<const std::byte> base;
    ModelCapacities capacities; ///< A guest brings nothing.
};

/// What a scene may come to. 0: what the set-up has.
struct SceneCapacities
{
    std::uint32_t objects{0}; ///< At once; at most kMaxObjects, at least those of the set-up.
    std::uint32_t pairs{0};   ///< At most kMaxPairs; 0: each tool with each object, or kMaxPairs.
};

/// What a frame is made of. `models[object.model]` must exist for every object, and for every tool
/// that is a mesh one that no object shows: FrameRefusal. Materials, poses and tools are not
/// checked here: theirs are the ranges of a SceneChange and of ToolSpec. The spans are read during
/// Frame::start() only.
struct FrameSetup
{
    std::span<const ModelSource> models;
    /// Those that are there at first, by their numbers and of generation 0.
    std::span<const ObjectSpec> objects;
    /// Where each of them stands; of later ones where its source stood.
    std::span<const ObjectPose> poses;
    std::span<const ToolSpec> tools; ///< All that there can be, and are at first.
    SceneCapacities capacities;
    /// Of the pools, beside what models bring: in it guests come and go.
    ModelCapacities for_guests;
    std::int64_t period_ns{1'000'000};         ///< Above 0, which run() asserts.
    std::int64_t pose_age_max_ns{100'000'000}; ///< Older poses make answers stale.
    /// A model that fits its pools is loaded and refined fully, once (static mode).
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    /// Coarse faces count as the surface where that changes a force by no more than this, and by no
    /// more than a quarter of a quantum; and farther where pools or budgets don't suffice for that
    /// (SurfaceTolerance). 0: only exact faces do. For tools that are no meshes.
    double force_tolerance_n{0.0};
    FrameVariant variant;            ///< As it is: the frame that ships.
    const Kernels* kernels{nullptr}; ///< Null: best_kernels(). Outlive the frame.
};

/// Why there is no frame.
enum class FrameRefusal : std::uint8_t
{
    too_many,         ///< More tools, objects, pairs or models than limits.hpp allows, no tool or
                      ///< no model, or more objects than SceneCapacities has room for.
    too_many_faces,   ///< The models bring more than kMaxPoolFaces.
    unknown_model,    ///< An object or a tool names a model that isn't there, a tool a guest.
    shared_model,     ///< A tool names a model that an object shows.
    header_refused,   ///< A model's header did not pass its checks.
    base_refused,     ///< A model's base mesh did not pass its checks.
    bad_tolerance,    ///< The force tolerance is not 0 to kForceToleranceMax_n.
    memory_too_small, ///< The lent memory is less than required_bytes().
};

/// One line for the user; static.
[[nodiscard]] const char* refusal_text(FrameRefusal refusal) noexcept;

/// Whether a model of the set-up comes and goes.
[[nodiscard]] inline bool is_guest(const FrameSetup& setup, std::size_t model) noexcept
{
    return setup.models[model].base.empty() && setup.for_guests.base_cells > 0;
}

/// What all models together bring to the pools, and what is for guests.
[[nodiscard]] ModelCapacities pool_capacities(const FrameSetup& setup) noexcept;

/// As they will be.
[[nodiscard]] SceneCapacities capacities_of(const FrameSetup& setup) noexcept;

/// Why there can be no frame of this, as far as that shows before it is made.
[[nodiscard]] std::optional<FrameRefusal> find_refusal(const FrameSetup& setup) noexcept;

} // namespace tactus
