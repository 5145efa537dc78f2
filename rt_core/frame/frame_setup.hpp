// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model_capacities.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/records/object_pose.hpp"
#include "rt_core/records/prediction.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

// Usable on any thread: that which calls Frame::start(). No call waits or allocates.
namespace tactus
{

struct Kernels;

/// Model of a frame: bytes of its header and base mesh, and its pool sizes.
struct ModelSource
{
    std::span<const std::byte> header; ///< Bytes of the header; copied, hashes are not verified.
    /// Coded base mesh, read once. Empty for a streamed model, which is loaded when a tool is near
    /// and removed again; it needs `for_streamed_models`.
    std::span<const std::byte> base;
    ModelCapacities capacities; ///< Pool sizes; unused for a streamed model.
};

/// Capacities of a scene; a value of 0 takes the size from the set-up.
struct SceneCapacities
{
    /// Largest number of objects at once; at most kMaxObjects, at least those of the set-up.
    std::uint32_t objects{0};
    /// Largest number of pairs, at most kMaxPairs. 0: one for each tool and object, up to
    /// kMaxPairs.
    std::uint32_t pairs{0};
};

/// Parts of a frame. Each object's model must exist, and a mesh tool needs a model that no object
/// shows; otherwise Frame::start() refuses. Materials, poses and tools are not checked: they must
/// be in the ranges of SceneChange and ToolSpec. The spans are read during Frame::start() only.
struct FrameSetup
{
    std::span<const ModelSource> models;
    /// Objects at start, by their numbers, with generation 0.
    std::span<const ObjectSpec> objects;
    /// Poses of these objects; missing ones are the source mesh's own pose.
    std::span<const ObjectPose> poses;
    std::span<const ToolSpec> tools; ///< All tools that can exist; all are present at start.
    SceneCapacities capacities;
    /// Additional pool capacities, for streamed models.
    ModelCapacities for_streamed_models;
    std::int64_t period_ns{1'000'000};         ///< Period of the loop; above 0, asserted by run().
    std::int64_t pose_age_max_ns{100'000'000}; ///< Age of a pose above which answers are stale.
    /// Load and refine a model fully, once, if it fits its pools (static mode).
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    /// Largest change of a force by coarse faces that count as the surface, of which the error is
    /// then at most a quarter of a quantum. The change is larger if pools or budgets don't suffice
    /// (SurfaceTolerance). 0: exact faces only, as always for mesh tools that want meeting pairs.
    double force_tolerance_n{0.0};
    FrameVariant variant; ///< Switches for measurements; the default is the shipped frame.
    /// Kernels for the queries, which must outlive the frame; null: best_kernels().
    const Kernels* kernels{nullptr};
};

/// Reasons for which a frame is refused.
enum class FrameRefusal : std::uint8_t
{
    /// No tool or no model, or more tools, models, objects or pairs than limits.hpp and
    /// SceneCapacities allow.
    too_many,
    too_many_faces,   ///< The models bring more than kMaxPoolFaces.
    unknown_model,    ///< A named model does not exist, or a tool names a streamed one or one that
                      ///< can be edited.
    shared_model,     ///< A tool names a model that an object shows.
    header_refused,   ///< A model's header did not pass its checks.
    base_refused,     ///< A model's base mesh did not pass its checks.
    bad_tolerance,    ///< The force tolerance is not 0 to kForceToleranceMax_n.
    memory_too_small, ///< The memory is less than required_bytes().
};

/// One line for the user on the reason; a static string.
[[nodiscard]] const char* refusal_text(FrameRefusal refusal) noexcept;

/// True if a model of the set-up is streamed.
[[nodiscard]] inline bool is_streamed_model(const FrameSetup& setup, std::size_t model) noexcept
{
    return setup.models[model].base.empty() && setup.for_streamed_models.base_cells > 0;
}

/// Sum of all models' capacities and those for streamed models.
[[nodiscard]] ModelCapacities pool_capacities(const FrameSetup& setup) noexcept;

/// Capacities of the set-up's scene, with each 0 replaced by its default.
[[nodiscard]] SceneCapacities capacities_of(const FrameSetup& setup) noexcept;

/// Reason to refuse a set-up that shows before the frame is made; none if there is none.
[[nodiscard]] std::optional<FrameRefusal> find_refusal(const FrameSetup& setup) noexcept;

} // namespace tactus
