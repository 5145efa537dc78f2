// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// Pool capacities of one model, in slots, as try_plan() finds them. Others need at least one page,
/// one index page, and room for the base mesh's faces (asserted), blocks and nodes.
struct ModelCapacities
{
    std::uint32_t pages{0};       ///< Pages of 64 records each: 8 KiB and tables.
    std::uint32_t index_pages{0}; ///< Index pages of 64 influence boxes each.
    std::uint32_t faces{0};       ///< Active faces.
    std::uint32_t blocks{0};      ///< Leaves of the AB-Tree.
    std::uint32_t nodes{0};       ///< Inner nodes of the AB-Tree.
    /// Cache off, to measure the benefit of the cache. Pages are only requested while refinement
    /// waits for their records. They are evicted once nothing waits and none of their records is
    /// refined. Then the two fronts agree to a page (figure 5 of the 3DIM 2005 paper).
    bool cache_off{false};
    /// Room for faces that edits add (EditedSurface), beside `faces`. 0: the model can't be edited,
    /// as a streamed one never can. Kept by try_plan().
    std::uint32_t edit_faces{0};
    /// Memory for base meshes of streamed models, in cells of one face and one vertex. Only used in
    /// FrameSetup::for_streamed_models.
    std::uint32_t base_cells{0};

    constexpr bool operator==(const ModelCapacities&) const noexcept = default;
};

/// Sum of each capacity over the models.
[[nodiscard]] ModelCapacities sum_of(std::span<const ModelCapacities> each) noexcept;

/// Bytes that models of these capacities take from the arena, for tables and pools. One of
/// `capacities` for each header (asserted). Called at start-up, like the functions below.
[[nodiscard]] std::size_t required_bytes(std::span<const ModelHeader> headers,
                                         std::span<const ModelCapacities> capacities) noexcept;

/// Pool capacities for streamed models: `cells` for all base meshes, `meshes` of them at once, as
/// many faces again for refinement, and pages.
[[nodiscard]] ModelCapacities streamed_model_room(std::uint32_t meshes, std::uint32_t cells,
                                                  std::uint32_t pages,
                                                  std::uint32_t index_pages) noexcept;

/// Plans capacities of models that fit into `bytes`, of which `cache_bytes` are for pages (0: the
/// default share), and the rest for active faces and the tree. All models get the same beyond their
/// base meshes, but no more than the whole model needs. False, with `capacities` invalid, if base
/// meshes and a few pages do not fit. Tries up to about 50 sizes, each in time linear in the
/// models.
/// - `headers` and `capacities` have the same size, 1 to kMaxModels (asserted).
/// - `capacities` come with the rooms for edits, `edit_faces`, and otherwise unused.
[[nodiscard]] bool try_plan(std::span<const ModelHeader> headers, std::size_t bytes,
                            std::size_t cache_bytes,
                            std::span<ModelCapacities> capacities) noexcept;

/// try_plan() for one model; `pages` is 0 if it does not fit.
[[nodiscard]] inline ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                                     std::size_t cache_bytes) noexcept
{
    ModelCapacities capacities;
    const bool fits = try_plan({&header, 1}, bytes, cache_bytes, {&capacities, 1});
    return fits ? capacities : ModelCapacities{};
}

} // namespace tactus
