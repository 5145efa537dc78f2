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

/// How much of each pool one model brings, in slots: what try_plan() says, or else at least one
/// page, one index page, and the faces, blocks and nodes of its base mesh, which is asserted of the
/// faces.
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
    /// Room for base meshes that come and go, in cells of a face and a vertex each. Only in what is
    /// for all models: FrameSetup::for_guests.
    std::uint32_t base_cells{0};

    constexpr bool operator==(const ModelCapacities&) const noexcept = default;
};

/// What the models of a frame share: each brings what its capacities say, and takes what it needs.
/// What a model needs as a whole is kept for it if it brings that; else its base mesh and a quarter
/// of what else it brings.
struct ModelPools
{
    /// `all` is what so many models bring together.
    ModelPools(Arena& arena, const ModelCapacities& all, std::uint32_t models) noexcept;

    RefineScratch scratch;
    FacePool faces;
    TreePool tree;
    PageSlots slots;    ///< The base mesh is the memory for those that come and go.
    BaseRoom base_room; ///< Which of it is taken.
    CachePool cache;
    LinkPool links; ///< The transport thread's, with the other ends of the cache's door.
};

/// The sum of each, of any models.
[[nodiscard]] ModelCapacities sum_of(std::span<const ModelCapacities> each) noexcept;

/// Bytes that models of these capacities, one each (asserted), take from the arena: tables, and
/// what they bring to the pools. At start-up, as what follows.
[[nodiscard]] std::size_t required_bytes(std::span<const ModelHeader> headers,
                                         std::span<const ModelCapacities> capacities) noexcept;

/// Pools in which guests come and go: base meshes of `cells` in all, `meshes` of them at once, half
/// of all faces for those, and pages for what is touched of them.
[[nodiscard]] ModelCapacities guest_room(std::uint32_t meshes, std::uint32_t cells,
                                         std::uint32_t pages, std::uint32_t index_pages) noexcept;

/// The capacities of up to kMaxModels models that fit into `bytes`: `cache_bytes` of them for pages
/// (0: the usual share), the rest for active faces and the tree. All bring the same beyond their
/// base meshes, but no more than the whole model needs. With less than the base meshes and a few
/// pages need, false, and `capacities` don't count. Tries up to some 50 sizes, each in time by the
/// models.
/// - `headers` and `capacities` are as many, 1 to kMaxModels (asserted).
[[nodiscard]] bool try_plan(std::span<const ModelHeader> headers, std::size_t bytes,
                            std::size_t cache_bytes,
                            std::span<ModelCapacities> capacities) noexcept;

/// The same of one model; `pages` is 0 where it does not fit.
[[nodiscard]] inline ModelCapacities plan_capacities(const ModelHeader& header, std::size_t bytes,
                                                     std::size_t cache_bytes) noexcept
{
    ModelCapacities capacities;
    const bool fits = try_plan({&header, 1}, bytes, cache_bytes, {&capacities, 1});
    return fits ? capacities : ModelCapacities{};
}

/// How much of a model is here.
enum class Residence : std::uint8_t
{
    partial,  ///< What the tools need.
    filling,  ///< On its way to:
    complete, ///< Everything, refined fully: nothing is left to load, refine or refit (static
              ///< mode).
};

/// One model's forest, tree, cache and front, in the model's frame, refined for the union of what
/// its objects' tools need. Everything is the haptic thread's but `linker`, the transport thread's.
/// Does not move: its parts point at one another.
struct Model
{
    /// `header` views bytes that outlive the model, as the pools do; `base` was parsed for it into
    /// `slots`, whose pages are the pools'. No other model has the id. A model without a base mesh
    /// is a guest: it is known at first, comes when it is wanted, and goes again.
    Model(Arena& arena, ModelPools& shared, ModelId id, const ModelHeader& model_header,
          PageSlots model_slots, const ModelCapacities& model_capacities,
          const Kernels& kernels) noexcept;
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    Model(Model&&) = delete;
    Model& operator=(Model&&) = delete;
    ~Model() = default;

    /// Offers the tree the faces that found no place in it before, and refits it.
    void refit(WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// The frame's first stage, after what has come was adopted: asks for what the regions of the
    /// ranking that name this model lack.
    void load(ModelId id, const RegionRanking& ranking, const Budgets& budgets, std::uint32_t frame,
              WorkCounters& work, FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// How far ahead of a tool chunks have to be asked for at present, in seconds > 0.
    [[nodiscard]] double lead_s(std::int64_t period_ns) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_complete() const noexcept { return residence == Residence::complete; }
    /// Whether it is here as a whole, or on its way to that.
    [[nodiscard]] bool is_whole() const noexcept { return residence != Residence::partial; }
    /// From now on it is refined where tools need it, and no finer than they do.
    void end_whole() noexcept { residence = Residence::partial; }
    /// After a frame in which nobody asked for anything: whether another one like it would change
    /// nothing.
    [[nodiscard]] bool is_at_rest() const noexcept
    {
        return is_complete() || stage == ModelStage::known ||
               (is_here() && residence == Residence::partial && forest.refined_records() == 0 &&
                tree.is_complete() && cache.wishes_under_way() == 0);
    }
    /// Whether its surface may be asked.
    [[nodiscard]] bool is_here() const noexcept { return stage == ModelStage::resident; }
    /// Whether it is known and may be wanted: one that didn't come waits a while.
    [[nodiscard]] bool may_come(std::uint32_t frame) const noexcept
    {
        return stage == ModelStage::known && cache.may_want_base(frame);
    }
    /// Known -> wanted, with room for its base mesh kept; false, with nothing changed, where there
    /// is none.
    [[nodiscard]] bool try_want() noexcept TACTUS_NONBLOCKING;
    /// One frame of wanted, arriving or leaving: up to `entering` faces go in and `leaving` out,
    /// which are fewer afterwards. One that is wanted and whose base mesh doesn't come is known
    /// again.
    void go_on(std::uint32_t& entering, std::uint32_t& leaving, std::uint32_t frame,
               WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// Whether its base mesh may come, to lie from this cell on.
    [[nodiscard]] bool awaits_base(std::uint32_t first_cell) const noexcept
    {
        return stage == ModelStage::wanted && !cache.has_base() && first_cell == first_cell_;
    }
    /// Resident -> leaving: a guest that no pair is of, or whose pairs have lost it.
    void leave() noexcept TACTUS_NONBLOCKING;
    /// The state after a frame.
    [[nodiscard]] ModelOutput output() const noexcept TACTUS_NONBLOCKING;
    /// Whether all of the model has room at once.
    [[nodiscard]] bool fits() const noexcept;
    /// The refinement in three parts. What is asked of the model in this frame, which must stay
    /// until its end: merges what all of it left behind.
    void begin_refinement(std::span<const RefineRequest> requests, const Budgets& budgets,
                          WorkCounters& work) noexcept TACTUS_NONBLOCKING;
    /// After some of the requests had their splits: goes on to everything, while the model is
    /// filling, until the frame has done `limit` splits.
    void fill(std::uint32_t limit, std::uint32_t frame, WorkCounters& work,
              FrameFault& faults) noexcept TACTUS_NONBLOCKING;
    /// With the cache off, gives pages back that are of no use while no request waits.
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
    std::uint32_t revision{0}; ///< Another one after each refit that changed something.
    bool is_guest{false};
    ModelStage stage{ModelStage::resident};

private:
    void end_stay() noexcept;
    void dissolve(std::uint32_t& leaving, std::uint32_t frame, WorkCounters& work) noexcept;
    /// Whether this frame may ask for what the region lacks.
    [[nodiscard]] bool may_ask_for(const RankedRegion& region) const noexcept TACTUS_NONBLOCKING;

    ModelPools* shared_;
    std::uint32_t first_cell_{0}; ///< Of a guest's base mesh, from wanted to leaving.
};

/// What a frame keeps of a model beside its output.
struct ModelSlot
{
    std::optional<Model> model;
    bool is_busy{false};           ///< Whether this frame looks at it,
    std::uint32_t paired_frame{0}; ///< and when a pair was of it last.
    std::uint32_t requests{0};     ///< Of this frame,
    std::uint32_t requests_end{0}; ///< and where they end among those of all models.
};

} // namespace tactus
