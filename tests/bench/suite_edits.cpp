// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `edits`: a tool carves its way along a surface, thirty times a second, beside the same
/// motion on the unchanged surface.

#include "host_tools/edit/surface_editor.hpp"
#include "platform/machine/pool_memory.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/peers/all_peers.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/edit_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace tactus::bench
{
namespace
{

constexpr std::uint32_t kChanges = 40;
/// Faces that a change adds or removes, in edits of kMaxEditFaces.
constexpr std::uint32_t kChangedFaces = 1'008;

/// Adds kChangedFaces in a room, or removes them again.
std::vector<EditContent> change_of(const ModelHeader& header, std::uint32_t& revision, bool adds)
{
    std::vector<EditContent> edits;
    for (std::uint32_t slot = 0; slot < kChangedFaces; ++slot)
    {
        if (slot % kMaxEditFaces == 0)
        {
            edits.emplace_back().revision = ++revision;
        }
        if (!adds)
        {
            edits.back().removed.push_back({header.counts().face_ids() + slot});
            continue;
        }
        AddedFace face{slot, 0, {}};
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t quanta =
                (slot + corner * corner) % header.fields().extent_quanta[0];
            face.corners_m[corner] = {static_cast<float>(quanta) * header.quantum_m(), 0.0F, 0.0F};
        }
        edits.back().added.push_back(face);
    }
    return edits;
}

/// Times of changes of about 1,000 faces from a server's call until a controller has all of their
/// edits, over loopback sockets, both stepped by this thread. A frame takes one of the edits.
void add_arrival_rows(CaseRows& rows, const Scene& scene, double period_s)
{
    test::isolate_domains();
    auto store = needed(ModelStore::open(scene.model.path));
    const auto hash = store.hash();
    std::vector<dds::PublishedModel> models;
    models.push_back({"model", std::move(store), kChangedFaces});
    const auto server = needed(dds::DdsServer::create(1, std::move(models), {}, {},
                                                      dds::Party::server, dds::Editors{true, {}}));
    const ModelHeader header = server->models()[0].store().header();
    const auto client = needed(dds::DdsClient::create(2, "bench", {}));
    dds::EditReader reader(client->domain(), client->catalogue(),
                           {{"model", hash, header, kChangedFaces}}, {});
    reader.follow(0, server->epoch());
    std::uint32_t revision = 0;
    std::vector<double> arrival_ms;
    for (std::uint32_t change = 0; change <= kChanges; ++change)
    {
        const std::vector<EditContent> edits = change_of(header, revision, change % 2 == 0);
        const BenchClock::time_point start = BenchClock::now();
        if (const auto fault = server->edits()->publish(0, edits))
        {
            throw Failure(fault->text);
        }
        std::size_t arrived = 0;
        while (arrived < edits.size())
        {
            server->step();
            client->catalogue().refresh();
            reader.poll();
            while (reader.next(0) != nullptr)
            {
                reader.pop(0);
                ++arrived;
            }
        }
        if (change > 0) // The first one waits for the reader to be found.
        {
            arrival_ms.push_back(microseconds(start, BenchClock::now()) * 1e-3);
        }
    }
    const double edits = (kChangedFaces + kMaxEditFaces - 1) / kMaxEditFaces;
    const Spread arrival = spread_of(arrival_ms);
    rows.add("1,008 faces over loopback, p50", arrival.p50, "ms");
    rows.add("1,008 faces over loopback, p99", arrival.p99, "ms");
    rows.add("1,008 faces felt, p50", arrival.p50 + edits * period_s * 1e3, "ms", 60.0);
}

constexpr std::uint32_t kFramesAnEdit = 33;
/// Depth of a carved groove below the tool, as a share of the tool's radius.
constexpr double kDepth = 0.05;

struct EditsCase
{
    SceneSource scene;
    std::uint32_t frames;
    std::size_t pool_mib;
    std::uint32_t room; ///< Room for added faces.
};

/// Edits of a run, computed beforehand as a server does it.
struct Carving
{
    std::vector<EditContent> edits;
    std::vector<double> carve_ms;    ///< Time of the editor for each change.
    std::vector<double> coded_bytes; ///< Bytes on the wire of each change.
    std::vector<double> faces;       ///< Faces removed and added by each change.
    std::uint32_t added_faces{0};    ///< Added faces at the end.
    double volume_m3{0.0};
    std::size_t refused{0};
};

/// Carves along the goals: every kFramesAnEdit frames a sweep of the tool to the present place, a
/// little deeper. Edits go into the run, at most kMaxEditsPerFrame a frame.
Carving carve_along(const ModelStore& store, FrameRun& run, std::uint32_t room)
{
    const DecodedModel model = decode_all(store);
    auto created = SurfaceEditor::create(model, room);
    if (!created)
    {
        throw Failure(created.error().text);
    }
    SurfaceEditor editor = std::move(created).value();
    const Vec3 origin_m = model.header().origin_m();
    const double radius_m = run.rig.tools[0].radius_m;
    Carving carving;
    std::size_t first_free = 0;
    for (std::size_t i = run.lead_in; i + kFramesAnEdit < run.goals_m.size(); i += kFramesAnEdit)
    {
        tactus::Sweep sweep;
        sweep.core_m = {Vec3(0.0, 0.0, 0.0)};
        sweep.radius_m = radius_m * (1.0 + kDepth);
        sweep.from_m = origin_m + run.goals_m[i];
        sweep.to_m = origin_m + run.goals_m[i + kFramesAnEdit];
        const BenchClock::time_point start = BenchClock::now();
        auto carved = editor.carve(sweep);
        const BenchClock::time_point end = BenchClock::now();
        if (!carved)
        {
            ++carving.refused;
            continue;
        }
        const SurfaceChange& change = carved.value();
        if (change.edits.empty())
        {
            continue;
        }
        carving.carve_ms.push_back(microseconds(start, end) * 1e-3);
        carving.volume_m3 += change.volume_m3;
        double bytes = 0.0;
        double faces = 0.0;
        first_free = std::max(first_free, i + kFramesAnEdit);
        for (const EditContent& edit : change.edits)
        {
            std::vector<std::byte> coded;
            encode_edit(edit, model.header(), coded);
            bytes += static_cast<double>(coded.size());
            faces += static_cast<double>(edit.removed.size() + edit.added.size());
            if (first_free < run.goals_m.size())
            {
                run.edits.push_back({first_free++, edit});
            }
        }
        carving.coded_bytes.push_back(bytes);
        carving.faces.push_back(faces);
    }
    carving.added_faces = editor.added_count();
    return carving;
}

double sum_of(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Time of refinement and refit of all frames.
double refining_us(const FrameReplay& replay)
{
    return sum_of(replay.stage_us(Stage::refine).least()) +
           sum_of(replay.stage_us(Stage::refit).least());
}

void add_server_rows(CaseRows& rows, const Carving& carving, double run_s)
{
    const Spread carve = spread_of(carving.carve_ms);
    const Spread faces = spread_of(carving.faces);
    rows.add("changes", static_cast<double>(carving.carve_ms.size()), "");
    rows.add("changes refused", static_cast<double>(carving.refused), "", 0.0);
    rows.add("faces of a change, p50", faces.p50, "");
    rows.add("faces of a change, max", faces.max, "");
    rows.add("added faces at the end", carving.added_faces, "");
    rows.add("editor, a change, p50", carve.p50, "ms");
    rows.add("editor, a change, p99", carve.p99, "ms");
    rows.add("wire", sum_of(carving.coded_bytes) / run_s / 1e3, "KB/s", 200.0);
}

/// Times of static trees, which an edit makes to be built again over all faces.
void add_rivals(const Scene& scene, CaseRows& rows)
{
    const StaticModel made(scene);
    const Model& model = made.model();
    std::vector<ChangedFace> faces;
    for (std::uint32_t face = 0; face < model.header.counts().face_ids(); ++face)
    {
        if (const PrimId prim = model.forest.find({face}); !prim.is_none())
        {
            faces.push_back(model.forest.describe(prim));
        }
    }
    const TreeCapacities capacities = model.tree.pool().capacities();
    Arena measured = Arena::measuring();
    const TreePool measured_pool(measured, capacities);
    const PoolMemory memory(measured.used());
    Arena arena(memory.span());
    TreePool pool(arena, capacities);
    AbTree tree(pool, ModelId{0}, capacities, model.header.quantum_m());
    const BenchClock::time_point start = BenchClock::now();
    for (const ChangedFace& face : faces)
    {
        tree.insert(face);
    }
    static_cast<void>(tree.refit());
    const BenchClock::time_point end = BenchClock::now();
    rows.add("static tree built again", microseconds(start, end) * 1e-3, "ms").by = "Tactus";
    for (const PointPeer& peer : point_peers())
    {
        if (scene.model.faces.size() > peer.most_faces)
        {
            continue;
        }
        const BenchClock::time_point began = BenchClock::now();
        const auto built = peer.make(scene.model.faces, kRadius_diag * scene.model.diagonal_m);
        rows.add("static tree built again", microseconds(began, BenchClock::now()) * 1e-3, "ms")
            .by = peer.name;
    }
}

void run_edits_case(const CaseContext& context, const EditsCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    constexpr double kSpeed_diag_per_s = 0.1;
    constexpr std::uint32_t kSplits = 64;
    const FrameRun still =
        make_slide(scene, kSpeed_diag_per_s, kSplits, test_case.pool_mib * kMiB, test_case.frames);
    FrameRun carved = still;
    carved.rig.edit_faces = test_case.room;
    auto store = ModelStore::open(scene.model.path);
    if (!store)
    {
        throw Failure(store.error().text);
    }
    const Carving carving = carve_along(store.value(), carved, test_case.room);
    FrameReplay plain(still);
    FrameReplay edited(carved);
    for (std::uint32_t pass = 0; pass < context.options.passes_or(3, 1); ++pass)
    {
        plain.run(1);
        edited.run(1);
    }
    Row common = context.common_row(scene.model.name);
    common.setting = "30 a second";
    common.frames = still.counted();
    common.hash = edited.hash();
    CaseRows rows(context.rows, common);
    add_server_rows(rows, carving, static_cast<double>(still.counted()) * kPeriod_s);
    const Spread frame = spread_of(edited.sum_us(CacheState::warm).least());
    const Spread plain_frame = spread_of(plain.sum_us(CacheState::warm).least());
    rows.add("frame, p50", frame.p50, "us");
    rows.add("frame, p99", frame.p99, "us");
    rows.add("frame, max", frame.max, "us");
    rows.add("frame, p99 to that without edits", frame.p99 / plain_frame.p99, "", 1.3);
    rows.add("T_R + T_B, mean", refining_us(edited) / static_cast<double>(common.frames), "us");
    rows.add("T_R + T_B to that without edits", refining_us(edited) / refining_us(plain), "", 1.3);
    rows.add("edits refused by the frame", static_cast<double>(edited.work().edits_refused), "",
             0.0);
    rows.add("frames in contact", static_cast<double>(edited.work().contacts), "");
    rows.add("of them without an exact answer", static_cast<double>(edited.work().uncertified), "");
    rows.add("the same without edits", static_cast<double>(plain.work().uncertified), "");
    if (edited.allocations())
    {
        rows.add("allocations", static_cast<double>(*edited.allocations()), "", 0.0);
    }
    add_arrival_rows(rows, scene, kPeriod_s);
    add_rivals(scene, rows);
}

} // namespace

Suite edits_suite()
{
    return {"edits", []
            {
                return std::vector<Case>{make_case("bunny-69k", When::always, run_edits_case,
                                                   EditsCase{kBunny, 4'000, 32, 65'536}),
                                         make_case("bunny-1.1M", When::full_only, run_edits_case,
                                                   EditsCase{kFineBunny, 60'000, 96, 262'144}),
                                         make_case("tiny", When::named_only, run_edits_case,
                                                   EditsCase{kTiny, 500, 16, 16'384})};
            }};
}

} // namespace tactus::bench
