// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/edit_arrival.hpp"

#include "tests/bench/failure.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/unit/transport/dds_rig.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/edit_reader.hpp"

#include <cstdint>
#include <memory>
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

} // namespace

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

} // namespace tactus::bench
