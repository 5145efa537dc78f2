// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/cache/chunk_inbox.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/refine/refiner.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_table.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// How much of each pool one model gets.
struct ModelCapacities
{
    std::uint32_t pages{0};       ///< Of 64 records, 8 KiB and some tables each.
    std::uint32_t index_pages{0}; ///< Of 64 influence boxes.
    std::uint32_t faces{0};       ///< Active faces.
    std::uint32_t blocks{0};      ///< Leaves of the AB-Tree.
    std::uint32_t nodes{0};       ///< Inner nodes of the AB-Tree.
    /// Pages are asked for only while the refinement waits for records, never ahead of need, and go
    /// back as soon as it waits for none and no record in them is refined: then the refined and the
    /// loaded front agree to a page (the paper's figure 5). For measuring what a cache is worth.
    bool cache_off{false};
};

/// Bytes that a model of these capacities takes from the arena, tables and inbox included.
[[nodiscard]] std::size_t required_bytes(const ModelHeader& header,
                                         const ModelCapacities& capacities) noexcept;

/// The capacities that fit into `bytes`: `cache_bytes` of them for pages (0: the usual share), the
/// rest for active faces and the tree. No more than the whole model needs. With less than the base
/// mesh and a few pages need, `pages` is 0 and nothing else counts.
[[nodiscard]] ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                              std::size_t cache_bytes) noexcept;

/// How much of a model is here.
enum class Residence : std::uint8_t
{
    partial,  ///< What the tools need.
    filling,  ///< On its way to:
    complete, ///< Everything, refined fully: nothing is left to load, refine or refit (static
              ///< mode).
};

/// One model's forest, tree, cache and front, in the model's frame, refined for the union of what
/// its objects' tools need. Everything is the haptic thread's but `linker` (the transport
/// thread's) and `inbox` (between both). Does not move: its parts point at one another.
struct Model
{
    /// `header` views bytes that outlive the model; `base` was parsed for it into `slots`.
    Model(Arena& arena, const ModelHeader& model_header, PageSlots model_slots,
          const ModelCapacities& model_capacities, const Kernels& kernels) noexcept;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    Model(Model&&) = delete;
    Model& operator=(Model&&) = delete;
    ~Model() = default;

    /// Offers the tree the faces that found no place in it before, and refits it.
    void refit(FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// The frame's first stage: takes what has come, and asks for what the regions of the ranking
    /// that name this model lack. Returns what was taken, valid until the next call.
    [[nodiscard]] DoorTake load(ModelId id, const RegionRanking& ranking, const Budgets& budgets,
                                std::uint32_t frame,
                                FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// How far ahead of a tool chunks have to be asked for at present, in seconds > 0.
    [[nodiscard]] double lead_s(std::int64_t period_ns) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_complete() const noexcept { return residence == Residence::complete; }
    /// The state after a frame.
    [[nodiscard]] ModelOutput output() const noexcept TACTUS_NONBLOCKING;
    /// Whether all of the model has room at once.
    [[nodiscard]] bool fits() const noexcept;
    /// Moves the refined front to what the questions need; with the cache off, gives unused pages
    /// back.
    void refine(std::span<const RefineQuestion> questions, const Budgets& budgets,
                std::uint32_t frame, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    ModelHeader header;
    ModelCapacities capacities;
    PageSlots slots;
    ChunkInbox inbox;
    Linker linker;
    PageTable pages;
    ChunkCache cache;
    AbTree tree;
    VertexForest forest;
    Refiner refiner;
    std::uint32_t pages_used_max{0};
    WorkCounters work; ///< Of this frame; budgets are per model.
    Residence residence{Residence::partial};
    bool is_refined{false}; ///< The last refinement left nothing to do.

private:
    /// Whether this frame may ask for what the region lacks.
    [[nodiscard]] bool may_ask_for(const RankedRegion& region) const noexcept TACTUS_NONBLOCKING;
};

} // namespace tactus
