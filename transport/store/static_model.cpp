// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/store/static_model.hpp"

#include "rt_core/base/arena.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/query/contact_report.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/surface_query.hpp"
#include "transport/base/number_form.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <limits>
#include <new>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

/// Memory limit for planning the pools, which then take only the memory that they need.
constexpr std::size_t kAllBytes = std::size_t{1} << 40U;
constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();
/// Pause after a frame without progress.
constexpr std::chrono::milliseconds kPause{1};
/// Factor on the nearest distance within which faces count as equally near, despite rounding.
constexpr double kAsFar = 1.0 + 1e-9;

/// Maximum factor on the usual room of the tree; suffices for blocks of a single face each.
constexpr std::uint32_t kMostRoom = 16;

/// Budgets of a frame without a deadline.
constexpr Budgets all_at_once()
{
    Budgets budgets;
    budgets.splits = kMaxSplitsPerFrame;
    budgets.pages = 256;
    budgets.requests = 256;
    return budgets;
}

struct AlignedDelete
{
    void operator()(std::byte* bytes) const
    {
        ::operator delete (bytes, std::align_val_t{Arena::kAlignment});
    }
};

std::string piece_count(std::uint64_t pieces)
{
    return counted(pieces, "piece is", "pieces are");
}

} // namespace

struct StaticModel::Parts
{
    ServedModel served;
    std::optional<ModelHeader> header; ///< Parsed from served.header, which it refers to.
    std::unique_ptr<std::byte, AlignedDelete> memory;
    std::optional<Arena> arena;
    std::optional<Frame> frame;
    std::optional<ChunkLoader> chunk_loader;

    /// Plans the memory and starts the frame, with `room` times the usual tree blocks and nodes.
    [[nodiscard]] std::optional<Refusal> start(std::uint32_t room);
    /// Runs frames until the model is loaded and refined as far as the tree has room.
    [[nodiscard]] std::optional<Refusal> refine(std::chrono::milliseconds patience);
};

std::optional<Refusal> StaticModel::Parts::start(std::uint32_t room)
{
    chunk_loader.reset();
    frame.reset();
    const std::array objects{ObjectSpec{ModelId{0}}};
    const std::array poses{ObjectPose{}};
    std::array tools{ToolSpec{}};
    tools[0].radius_m = header->diagonal_m();
    tools[0].query_only = true;
    std::array sources{ModelSource{served.header, served.base, {}}};
    if (!try_plan({&*header, 1}, kAllBytes, 0, {&sources[0].capacities, 1}))
    {
        return Refusal{fmt::format("{}: the model needs more than 1 TiB of memory", served.name)};
    }
    sources[0].capacities.blocks *= room;
    sources[0].capacities.nodes *= room;
    FrameSetup setup;
    setup.models = sources;
    setup.objects = objects;
    setup.poses = poses;
    setup.tools = tools;
    setup.static_when_it_fits = true;
    const ModelCapacities& pools = sources[0].capacities;
    const std::size_t bytes = Arena::round_up(Frame::required_bytes(setup)) +
                              ChunkLoader::required_bytes(pools.pages, pools.index_pages);
    memory.reset(static_cast<std::byte*>(
        ::operator new (bytes, std::align_val_t{Arena::kAlignment}, std::nothrow)));
    if (memory == nullptr)
    {
        return Refusal{
            fmt::format("{}: not enough memory: {} MiB are needed", served.name, bytes >> 20U)};
    }
    arena.emplace(std::span{memory.get(), bytes});
    if (const auto started = Frame::start(frame, *arena, setup); !started)
    {
        return Refusal{fmt::format("{}: {}", served.name, refusal_text(started.error()))};
    }
    ModelPools& shared = frame->pools();
    chunk_loader.emplace(*arena, shared.slots, shared.cache.queues, Log{});
    Model& model = frame->model({0});
    chunk_loader->add(model.header, model.linker, *served.link, served.name);
    return std::nullopt;
}

std::optional<Refusal> StaticModel::Parts::refine(std::chrono::milliseconds patience)
{
    using Clock = std::chrono::steady_clock;
    const Model& model = frame->model({0});
    const std::uint32_t all = header->counts().chunks() + header->counts().index_pages();
    const std::array tools{ToolState{}};
    Clock::time_point last_progress = Clock::now();
    std::uint64_t done = 0;
    std::int64_t now_ns = 0;
    do
    {
        now_ns += 1'000'000;
        chunk_loader->step(now_ns);
        static_cast<void>(frame->run({tools, {}, all_at_once(), now_ns}));
        const std::uint64_t here = chunk_loader->counters().delivered;
        const std::uint64_t damaged = chunk_loader->counters().refused() + served.link->damaged();
        if (damaged > 0)
        {
            return Refusal{fmt::format("{}: {} damaged", served.name, piece_count(damaged))};
        }
        if (const std::uint64_t progress = here + model.forest.refined_records(); progress > done)
        {
            done = progress;
            last_progress = Clock::now();
        }
        else if (Clock::now() - last_progress > patience)
        {
            return Refusal{
                fmt::format("{}: {} of {} pieces arrived, but the next one did not within {} ms",
                            served.name, here, all, patience.count())};
        }
        else
        {
            std::this_thread::sleep_for(kPause);
        }
    } while (model.residence == Residence::filling);
    return std::nullopt;
}

Result<std::unique_ptr<StaticModel>, Refusal> StaticModel::open(const std::filesystem::path& path)
{
    auto served = serve_from_file(path, path.string(), {});
    if (!served)
    {
        return served.error();
    }
    return load(std::move(served).value());
}

Result<std::unique_ptr<StaticModel>, Refusal> StaticModel::load(ServedModel served,
                                                                std::chrono::milliseconds patience)
{
    auto parts = std::make_unique<Parts>();
    parts->served = std::move(served);
    parts->header = ModelHeader::parse(parts->served.header).value();
    // The usual room suffices if faces share their corners. Thin faces may need more.
    for (std::uint32_t room = 1; room <= kMostRoom; room *= 2)
    {
        auto refusal = parts->start(room);
        refusal = refusal ? refusal : parts->refine(patience);
        if (refusal)
        {
            return *std::move(refusal);
        }
        if (parts->frame->model({0}).is_complete())
        {
            return std::unique_ptr<StaticModel>(new StaticModel(std::move(parts)));
        }
    }
    return Refusal{fmt::format("{}: the model's tree needs more than {} times the usual memory",
                               parts->served.name, kMostRoom)};
}

StaticModel::StaticModel(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

StaticModel::~StaticModel() = default;

const ModelHeader& StaticModel::header() const noexcept
{
    return *parts_->header;
}

namespace
{

/// Answers distance queries, one at a time, on one thread.
class Asker
{
public:
    Asker(const Model& model, bool is_closed)
        : tree_(model.tree)
        , is_closed_(is_closed)
        , triangles_(kMaxLocalTriangles)
        , distances_m_(kMaxLocalTriangles)
    {
        surface_.triangles = triangles_;
        surface_.distances_m = distances_m_;
    }

    /// Distance of a point. Point and answer are in the model's frame.
    [[nodiscard]] PointDistance ask(const Vec3& point_m)
    {
        WalkBudget budget{kUnlimited, kUnlimited};
        const DistanceAnswer answer = query_distance(tree_, point_m, kInfinity, memory_, budget);
        return {answer.lower_m, answer.upper_m, answer.nearest_point_m,
                is_closed_ ? side_of(point_m, answer) : Side::unsigned_distance};
    }

private:
    [[nodiscard]] Side side_of(const Vec3& point_m, const DistanceAnswer& answer)
    {
        WalkBudget budget{kUnlimited, kUnlimited};
        gather_surface(tree_, point_m, kAsFar * answer.upper_m, memory_, budget, surface_);
        const PlacedCore core(PointCore{}, Similarity{.translation_m = point_m});
        report_contacts(core, 0.0, tree_, surface_, is_closed_, report_);
        return report_.side;
    }

    const AbTree& tree_;
    bool is_closed_;
    QueryMemory memory_;
    std::vector<LocalTriangle> triangles_;
    std::vector<double> distances_m_;
    LocalSurface surface_;
    ContactReport report_;
};

} // namespace

Result<Done, Refusal> StaticModel::distances(std::span<const Vec3> points_m,
                                             std::span<PointDistance> answers) const
{
    TACTUS_ASSERT(points_m.size() == answers.size());
    const ModelHeader& header = *parts_->header;
    for (std::size_t i = 0; i < points_m.size(); ++i)
    {
        if (is_beyond_kernels(points_m[i] - header.origin_m(), header.quantum_m()))
        {
            return Refusal{fmt::format("point {} ({:g} {:g} {:g}): not within {:g} m of the model",
                                       i, points_m[i].x(), points_m[i].y(), points_m[i].z(),
                                       kFarQuanta * static_cast<double>(header.quantum_m()))};
        }
    }
    Asker asker(parts_->frame->model({0}), header.is_closed());
    for (std::size_t i = 0; i < points_m.size(); ++i)
    {
        answers[i] = asker.ask(points_m[i] - header.origin_m());
        answers[i].nearest_m += header.origin_m();
    }
    return Done{};
}

} // namespace tactus
