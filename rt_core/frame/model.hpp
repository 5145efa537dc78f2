// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cache/cache_pool.hpp"
#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/forest/face_pool.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/region_ranking.hpp"
#include "rt_core/refine/refiner.hpp"
#include "rt_core/spm/base_room.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_table.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Pool capacities of one model, in slots: those of try_plan(). Otherwise at least one page, one
/// index page, and the faces, blocks and nodes of its base mesh, which is asserted for the faces.
struct ModelCapacities
{
    std::uint32_t pages{0};       ///< 64 records each: 8 KiB and some tables.
    std::uint32_t index_pages{0}; ///< 64 influence boxes each.
    std::uint32_t faces{0};       ///< Active faces.
    std::uint32_t blocks{0};      ///< Leaves of the AB-Tree.
    std::uint32_t nodes{0};       ///< Inner nodes of the AB-Tree.
    /// Cache off: pages are requested only while the refinement waits for records, never ahead of
    /// need. They are evicted as soon as it waits for none and no record in them is refined. Then
    /// the refined and the loaded front agree to a page (figure 5 of the 3DIM 2005 paper). For
    /// measuring the benefit of a cache.
    bool cache_off{false};
    /// Memory for base meshes of streamed models, in cells of a face and a vertex each. Only in
    /// capacities for all models: FrameSetup::for_streamed_models.
    std::uint32_t base_cells{0};

    constexpr bool operator==(const ModelCapacities&) const noexcept = default;
};

/// Shared pools of a frame's models: each model adds its capacities and takes what it needs. A
/// model that adds all that it needs as a whole has that reserved; any other has its base mesh and
/// a quarter of its further capacities reserved.
struct ModelPools
{
    /// Pools with the capacities `all` for `models` models.
    ModelPools(Arena& arena, const ModelCapacities& all, std::uint32_t models) noexcept;

    RefineScratch scratch;
    FacePool faces;
    TreePool tree;
    PageSlots slots;    ///< The base mesh is the memory for streamed models.
    BaseRoom base_room; ///< Taken cells of that memory.
    CachePool cache;
    /// Used by the transport thread, like the other ends of the cache's queues.
    LinkPool links;
};

/// Sum of each capacity over the models.
[[nodiscard]] ModelCapacities sum_of(std::span<const ModelCapacities> each) noexcept;

/// Bytes that models of these capacities, one each (asserted), take from the arena: tables, and
/// their pool capacities. At start-up, like the functions below.
[[nodiscard]] std::size_t required_bytes(std::span<const ModelHeader> headers,
                                         std::span<const ModelCapacities> capacities) noexcept;

/// Pool capacities for streamed models: base meshes of `cells` in all, `meshes` of them at once,
/// half of all faces for those, and pages for their touched parts.
[[nodiscard]] ModelCapacities streamed_model_room(std::uint32_t meshes, std::uint32_t cells,
                                                  std::uint32_t pages,
                                                  std::uint32_t index_pages) noexcept;

/// Plans the capacities of up to kMaxModels models that fit into `bytes`: `cache_bytes` of them for
/// pages (0: the default share), the rest for active faces and the tree. All models get the same
/// beyond their base meshes, but no more than the whole model needs. False if base meshes and a few
/// pages do not fit; `capacities` are then invalid. Tries up to about 50 sizes, each in time linear
/// in the models.
/// - `headers` and `capacities` have the same size, 1 to kMaxModels (asserted).
[[nodiscard]] bool try_plan(std::span<const ModelHeader> headers, std::size_t bytes,
                            std::size_t cache_bytes,
                            std::span<ModelCapacities> capacities) noexcept;

/// The same for one model; `pages` is 0 if it does not fit.
[[nodiscard]] inline ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                                     std::size_t cache_bytes) noexcept
{
    ModelCapacities capacities;
    const bool fits = try_plan({&header, 1}, bytes, cache_bytes, {&capacities, 1});
    return fits ? capacities : ModelCapacities{};
}

/// Resident share of a model.
enum class Residence : std::uint8_t
{
    partial,  ///< The parts that the tools need.
    filling,  ///< Loading towards `complete`.
    complete, ///< All of it, refined fully: nothing is left to load, refine or refit (static mode).
};

/// One model's forest, tree, cache and front, in the model's frame, refined for the union of its
/// objects' tools' needs. Everything is the haptic thread's except `linker`, the transport
/// thread's. Does not move: its parts point at one another.
struct Model
{
    /// `header` views bytes that outlive the model, as the pools do; `base` was parsed for it into
    /// `slots`, whose pages are the pools'. The id must be unique. A model without a base mesh is
    /// streamed: known at first, loaded on demand, and removed again.
    Model(Arena& arena, ModelPools& shared, ModelId id, const ModelHeader& model_header,
          PageSlots model_slots, const ModelCapacities& model_capacities,
          const Kernels& kernels) noexcept;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    Model(Model&&) = delete;
    Model& operator=(Model&&) = delete;
    ~Model() = default;

    /// Offers the tree again the faces that had no place in it, and refits it.
    void refit(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// First stage of the frame, after arrivals were adopted: requests missing chunks in the
    /// ranking's regions of this model.
    void load(ModelId id, const RegionRanking& ranking, const Budgets& budgets, std::uint32_t frame,
              WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// Present prediction horizon of chunk requests, in seconds > 0.
    [[nodiscard]] double horizon_s(std::int64_t period_ns) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_complete() const noexcept { return residence == Residence::complete; }
    /// True if the model is resident as a whole or loading towards that.
    [[nodiscard]] bool is_whole() const noexcept { return residence != Residence::partial; }
    /// Ends that state: the model is then refined only as tools need it.
    void end_whole() noexcept { residence = Residence::partial; }
    /// True if, after a frame without requests, another one like it would change nothing.
    [[nodiscard]] bool is_at_rest() const noexcept
    {
        return is_complete() || stage == ModelStage::known ||
               (is_resident() && residence == Residence::partial && forest.refined_records() == 0 &&
                tree.is_complete() && cache.requests_under_way() == 0);
    }
    /// True if its surface answers queries.
    [[nodiscard]] bool is_resident() const noexcept { return stage == ModelStage::resident; }
    /// True if it is known and may be requested; after a failed request it waits a while.
    [[nodiscard]] bool may_come(std::uint32_t frame) const noexcept
    {
        return stage == ModelStage::known && cache.may_want_base(frame);
    }
    /// Known -> wanted, with memory for its base mesh reserved; false, with nothing changed, if
    /// there is none.
    [[nodiscard]] bool try_want() noexcept TACTUS_NONBLOCKING;
    /// One frame of wanted, arriving or leaving: up to `entering` faces enter and `leaving` leave,
    /// and both are reduced by that. A wanted model whose base mesh doesn't arrive is known again.
    void go_on(std::uint32_t& entering, std::uint32_t& leaving, std::uint32_t frame,
               WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// True if its base mesh may arrive, into cells from `first_cell` on.
    [[nodiscard]] bool awaits_base(std::uint32_t first_cell) const noexcept
    {
        return stage == ModelStage::wanted && !cache.has_base() && first_cell == first_cell_;
    }
    /// Resident -> leaving, for a streamed model without pairs, or whose pairs have lost it.
    void leave() noexcept TACTUS_NONBLOCKING;
    /// The state after a frame.
    [[nodiscard]] ModelOutput output() const noexcept TACTUS_NONBLOCKING;
    /// True if all of the model fits at once.
    [[nodiscard]] bool fits() const noexcept;
    /// First of three parts of the refinement. Takes this frame's requests, which must stay until
    /// its end, and merges records that all of them left behind.
    void begin_refinement(std::span<const RefineRequest> requests, const Budgets& budgets,
                          WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// Second part, after some requests had their splits: refines the whole model, while it is
    /// filling, until the frame has done `limit` splits.
    void fill(std::uint32_t limit, std::uint32_t frame, WorkCounters& work,
              FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// Third part: evicts unused pages if the cache is off and no request waits.
    void end_refinement(std::span<const RefineRequest> requests,
                        WorkCounters& work) noexcept TACTUS_NONBLOCKING;

    ModelHeader header;
    ModelCapacities capacities;
    PageSlots slots;
    Linker linker;
    PageTable pages;
    ChunkCache cache;
    AbTree tree;
    VertexForest forest;
    Refiner refiner;
    std::uint32_t pages_used_max{0};
    Residence residence{Residence::partial};
    bool is_refined{false};    ///< The last refinement left nothing to do.
    std::uint32_t revision{0}; ///< Changes with each refit that changed something.
    bool is_streamed_model{false};
    ModelStage stage{ModelStage::resident};

private:
    void end_stay() noexcept;
    void dissolve(std::uint32_t& leaving, std::uint32_t frame, WorkCounters& work) noexcept;
    /// True if this frame may request missing chunks of the region.
    [[nodiscard]] bool may_ask_for(const RankedRegion& region) const noexcept TACTUS_NONBLOCKING;

    ModelPools* shared_;
    /// First cell of a streamed model's base mesh, from wanted to leaving.
    std::uint32_t first_cell_{0};
};

/// Data that a frame keeps for a model besides its output.
struct ModelSlot
{
    std::optional<Model> model;
    bool is_busy{false};           ///< This frame updates the model.
    std::uint32_t paired_frame{0}; ///< Last frame with a pair of the model.
    std::uint32_t requests{0};     ///< Number of requests in this frame.
    std::uint32_t requests_end{0}; ///< Their end in the list of all models.
};

} // namespace tactus
