// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/static_model.hpp"

#include "transport/chunk_loader.hpp"
#include "transport/store/model_store.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace tactus::bench
{

namespace
{

/// Budget beyond the needs of all queries here, so that none is truncated.
constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();
/// Memory of a whole model: pages 100, faces and tree 110, tables and the usual shares the rest.
constexpr std::size_t kBytesPerFace = 400;

} // namespace

std::size_t ample_pool_bytes(const Scene& scene)
{
    return 16 * kMiB + kBytesPerFace * scene.model.faces.size();
}

std::size_t static_pool_bytes(const Scene& scene)
{
    const auto store = ModelStore::open(scene.model.path); // The scene was made from it.
    const ModelHeader& header = store.value().header();
    const ModelCounts counts = header.counts();
    // Memory that belongs to no model, and the loader.
    const std::size_t beside = (std::size_t{1} << 20U) +
                               ChunkLoader::required_bytes(counts.chunks(), counts.index_pages());
    std::size_t bytes = 64 * scene.model.faces.size();
    for (;; bytes += bytes / 50)
    {
        const ModelCapacities capacities = plan_capacities(header, bytes, 0);
        if (capacities.pages >= counts.chunks() && capacities.faces >= counts.face_ids() &&
            capacities.index_pages >= counts.index_pages())
        {
            return bytes + beside;
        }
    }
}

namespace
{

/// Splits all records, dependencies first. False if one cannot be split or the tree is full.
bool refine_fully(Model& model)
{
    std::vector<RecordId> open;
    for (std::uint32_t i = 0; i < model.header.counts().records; ++i)
    {
        open.push_back({i});
        while (!open.empty())
        {
            const RecordId id = open.back();
            if (model.pages.is_refined(id))
            {
                open.pop_back();
                continue;
            }
            const VsplitRecord* record = model.pages.find_linked(id);
            if (record == nullptr)
            {
                return false;
            }
            if (const RecordId first = model.forest.missing_dependency(*record); !first.is_none())
            {
                open.push_back(first);
                continue;
            }
            if (model.forest.split(id) != VertexForest::SplitOutcome::done)
            {
                return false;
            }
        }
    }
    FrameFault faults = FrameFault::none;
    WorkCounters work;
    model.refit(work, faults);
    return faults == FrameFault::none;
}

} // namespace

std::unique_ptr<test::FrameRig> refined_rig(const Scene& scene, test::RigOptions options)
{
    options.pool_bytes = ample_pool_bytes(scene);
    options.chunk_loader_steps_per_frame = 32;
    auto rig = std::make_unique<test::FrameRig>(scene.model, options);
    load_everything(*rig);
    const Model& model = rig->model();
    if (!refine_fully(rig->model()) || model.forest.active_faces() != scene.model.faces.size() ||
        !model.tree.is_complete())
    {
        throw Failure(scene.model.name + ": could not be refined to the source mesh");
    }
    return rig;
}

double TactusQuery::distance_m(const Vec3& point_m, double band_m)
{
    last_point_m_ = point_m;
    last_band_m_ = band_m;
    WalkBudget budget{kUnlimited, kUnlimited};
    const DistanceAnswer answer = query_distance(tree_, point_m, band_m, memory_, budget);
    nodes_visited_ += budget.nodes_visited;
    triangles_tested_ += budget.triangles_tested;
    nearest_m_ = answer.nearest_point_m;
    const bool is_beyond = std::isinf(answer.upper_m) && answer.lower_m >= band_m;
    const bool is_exact = answer.upper_m - answer.lower_m <= 1e-12 + 1e-12 * answer.upper_m;
    return is_beyond || is_exact ? answer.upper_m : std::numeric_limits<double>::quiet_NaN();
}

void TactusQuery::warm_caches()
{
    const QueryMemory memory = memory_;
    warmed_m_ += distance_m(last_point_m_, last_band_m_);
    memory_ = memory;
}

} // namespace tactus::bench
