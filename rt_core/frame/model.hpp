// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cache/cache_pool.hpp"
#include "rt_core/cache/chunk_cache.hpp"
#include "rt_core/forest/edited_surface.hpp"
#include "rt_core/forest/face_pool.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/frame/model_capacities.hpp"
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

/// Pools that the models of a frame share: each model adds its capacities and takes what it needs.
/// A model that adds enough for all of itself has that reserved. Others have their base mesh and a
/// quarter of their further capacities reserved.
struct ModelPools
{
    /// Pools with the capacities `all` for `models` models.
    ModelPools(Arena& arena, const ModelCapacities& all, std::uint32_t models) noexcept;

    RefineScratch scratch;
    FacePool faces;
    TreePool tree;
    /// Slots of pages and index pages; the base mesh is the memory for all streamed models.
    PageSlots slots;
    BaseRoom base_room; ///< Cells of that base mesh that are in use.
    CachePool cache;
    /// Data of the linkers, for the transport thread only.
    LinkPool links;
};

/// Part of a model that is resident.
enum class Residence : std::uint8_t
{
    partial, ///< The parts that tools need are resident.
    filling, ///< The model is loading towards `complete`.
    /// All of the model is resident and refined: nothing is left to load, refine or refit (static
    /// mode).
    complete,
};

/// Forest, tree, cache and fronts of one model, in the model's frame, refined for all tools at its
/// objects. The haptic thread uses all of it except `linker`, which is the transport thread's. Must
/// not move: its parts point at one another.
struct Model
{
    /// `model_header` views bytes that outlive the model, as the pools do. `model_slots` hold its
    /// parsed base mesh, and the pools' pages. The id must be unique. A model without a base mesh
    /// is streamed: known at first, loaded when needed, and removed again.
    Model(Arena& arena, ModelPools& shared, ModelId id, const ModelHeader& model_header,
          PageSlots model_slots, const ModelCapacities& model_capacities,
          const Kernels& kernels) noexcept;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    Model(Model&&) = delete;
    Model& operator=(Model&&) = delete;
    ~Model() = default;

    /// Takes an edit of the surface. A refused one changes nothing.
    [[nodiscard]] std::optional<EditRefusal> edit(const SurfaceEdit& change, WorkCounters& work,
                                                  FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Adds faces that did not fit before to the tree, if possible, and refits the tree.
    void refit(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Requests missing chunks of the ranking's regions in this model. Part of the load stage,
    /// after arrivals were adopted.
    void load(ModelId id, const RegionRanking& ranking, const Budgets& budgets, std::uint32_t frame,
              WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// Prediction horizon of chunk requests, in seconds > 0: the present load latency plus the time
    /// to refine.
    [[nodiscard]] double horizon_s(std::int64_t period_ns) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_complete() const noexcept { return residence == Residence::complete; }
    /// True if the model is resident as a whole or loading towards that.
    [[nodiscard]] bool is_whole() const noexcept { return residence != Residence::partial; }
    /// Ends loading as a whole: the model is then refined only as tools need it.
    void end_whole() noexcept { residence = Residence::partial; }
    /// True if a further frame without requests would change nothing.
    [[nodiscard]] bool is_at_rest() const noexcept
    {
        return is_complete() || stage == ModelStage::known ||
               (is_resident() && residence == Residence::partial && forest.refined_records() == 0 &&
                tree.is_complete() && cache.requests_under_way() == 0);
    }
    /// True if the model's surface answers queries.
    [[nodiscard]] bool is_resident() const noexcept { return stage == ModelStage::resident; }
    /// True if the model is known and may be requested; after a failed request it waits a while.
    [[nodiscard]] bool may_come(std::uint32_t frame) const noexcept
    {
        return stage == ModelStage::known && cache.may_want_base(frame);
    }
    /// Moves the model from known to wanted and reserves memory for its base mesh. False, with
    /// nothing changed, if memory is missing.
    [[nodiscard]] bool try_want() noexcept TACTUS_NONBLOCKING;
    /// Does one frame's work of a wanted, arriving or leaving model. Up to `entering` faces enter
    /// and `leaving` faces leave; both are reduced by that. A wanted model whose base mesh does not
    /// arrive becomes known.
    void advance(std::uint32_t& entering, std::uint32_t& leaving, std::uint32_t frame,
                 WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// True if the model's base mesh may arrive in the cells from `first_cell` on.
    [[nodiscard]] bool awaits_base(std::uint32_t first_cell) const noexcept
    {
        return stage == ModelStage::wanted && !cache.has_base() && first_cell == first_cell_;
    }
    /// Moves a streamed model from resident to leaving. It must have no pairs, or pairs that have
    /// lost it.
    void leave() noexcept TACTUS_NONBLOCKING;
    /// State of the model after a frame.
    [[nodiscard]] ModelOutput output() const noexcept TACTUS_NONBLOCKING;
    /// True if the model's capacities hold all of the model.
    [[nodiscard]] bool fits() const noexcept;
    /// First part of a refinement: takes this frame's requests, which must stay until its end, and
    /// merges records that no request needs.
    void begin_refinement(std::span<const RefineRequest> requests, const Budgets& budgets,
                          WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// Second part, after some requests had their splits: refines a filling model everywhere, until
    /// the frame has done `limit` splits.
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
    EditedSurface edits;
    VertexForest forest;
    Refiner refiner;
    std::uint32_t pages_used_max{0};
    Residence residence{Residence::partial};
    bool is_refined{false};    ///< True if the last refinement left nothing to do.
    std::uint32_t revision{0}; ///< Number that grows with each refit that changed something.
    bool is_streamed_model{false};
    ModelStage stage{ModelStage::resident};

private:
    void end_stay() noexcept;
    void dissolve(std::uint32_t& leaving, std::uint32_t frame, WorkCounters& work) noexcept;
    /// True if this frame may request the missing chunks of a region.
    [[nodiscard]] bool may_ask_for(const RankedRegion& region) const noexcept TACTUS_NONBLOCKING;

    ModelPools* shared_;
    /// First cell of a streamed model's base mesh in ModelPools::base_room; valid from wanted to
    /// leaving.
    std::uint32_t first_cell_{0};
};

/// Slot of a model in ModelSet, with the frame's data about the model.
struct ModelSlot
{
    std::optional<Model> model;
    bool is_busy{false}; ///< True if frames update the model.
    /// Number of the last frame in which a pair had the model, or in which the model was added.
    std::uint32_t paired_frame{0};
    std::uint32_t requests{0};     ///< Number of refinement requests to the model in this frame.
    std::uint32_t requests_end{0}; ///< End of these requests in the list that is grouped by model.
};

} // namespace tactus
