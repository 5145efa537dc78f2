// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// make_corpus FOLDER: rewrites the seeds that contain this build's formats: models of one chunk,
/// of two with a border, and without records; recordings, a whole one and one with lost frames;
/// conversations with a udp device; edits of a model; requests of pieces; and a sample of each
/// other topic of DDS. The same build writes the same bytes.

#include "host_tools/shapes/shapes.hpp"
#include "platform/devices/udp/datagram.hpp"
#include "tests/fuzz/sample_script.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/platform/example_datagrams.hpp"
#include "tests/unit/recording/recorded_example.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/dds/piece_frame.hpp"
#include "transport/dds/topics.hpp"
#include "transport/edit_content.hpp"

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "tactus.h"

namespace
{

using namespace tactus;
using Bytes = std::vector<std::byte>;
namespace fs = std::filesystem;

void put_seed(const fs::path& path, std::span<const std::byte> bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

void make_models(const fs::path& folder)
{
    fs::create_directories(folder);
    // There is no extension: files that end in .spm are products and not kept.
    const auto add = [&](const char* name, const TriangleMesh& mesh, std::uint32_t base_faces)
    {
        fs::copy_file(test::test_model(name, mesh, base_faces).path, folder / name,
                      fs::copy_options::overwrite_existing);
    };
    add("one_chunk", make_shape(Shape::sphere, 100).value(), 16);
    add("two_chunks", make_shape(Shape::terrain, 200).value(), 24);
    add("no_records", make_thin_plate(2, 0.01).value(), 500);
}

void make_recordings(const fs::path& folder)
{
    const test::TinyModel model = test::make_tiny_model({.records = 70});
    put_seed(folder / "whole", test::example_recording(model));
    put_seed(folder / "lost_frames", test::example_recording(model, 3));
}

/// Adds a datagram or an edit for fuzz::InputParts.
template <typename Content>
void add_part(Bytes& script, unsigned control, const Content& content)
{
    for (const std::size_t byte :
         {std::size_t{control}, content.size() % 256, content.size() / 256})
    {
        script.push_back(static_cast<std::byte>(byte));
    }
    script.insert(script.end(), content.begin(), content.end());
}

/// A description, three samples and a force, in one version.
Bytes conversation(std::uint16_t version)
{
    constexpr unsigned kAfterMillisecond = 1;
    constexpr unsigned kOfSession = 8;
    auto description = test::example_description();
    auto sample = test::example_sample();
    auto force = test::example_force();
    description.version = version;
    sample.version = version;
    force.version = version;
    Bytes script;
    add_part(script, 0, udp::encode(description));
    for (int i = 0; i < 3; ++i)
    {
        add_part(script, kAfterMillisecond | kOfSession, udp::encode(sample));
        ++sample.address.sequence;
        sample.time_ns += 1'000'000;
    }
    add_part(script, kAfterMillisecond, udp::encode(force));
    return script;
}

/// Model of the targets that take edits.
struct EditedModel
{
    test::TinyModel model = test::make_tiny_model({});
    ModelHeader header = ModelHeader::parse(model.header).value();

    [[nodiscard]] Bytes coded(const EditContent& edit) const
    {
        Bytes bytes;
        encode_edit(edit, header, bytes);
        return bytes;
    }
    /// An edit that removes a source face and adds two faces with a common edge.
    [[nodiscard]] EditContent square() const
    {
        const float q = header.quantum_m();
        const Vec3f a{0.0F, 0.0F, 0.0F};
        const Vec3f b{q, 0.0F, 0.0F};
        const Vec3f c{0.0F, q, 0.0F};
        const Vec3f d{q, q, 0.0F};
        return {1, {FaceId{3}}, {{0, 7, {a, b, c}}, {5, 7, {b, d, c}}}, {a, d}};
    }
};

void make_edits(const fs::path& folder)
{
    constexpr unsigned kFollows = 1;
    constexpr unsigned kCopies = 2;
    const EditedModel edited;
    const std::uint32_t face_ids = edited.header.counts().face_ids();
    EditContent edit = edited.square();
    Bytes script{std::byte{1}}; // Room for 8 faces.
    add_part(script, kFollows, edited.coded(edit));
    edit.removed = {FaceId{face_ids}};
    edit.added.pop_back();
    edit.added[0].bucket = 8;
    add_part(script, kFollows | kCopies, edited.coded(edit));
    edit.removed = {FaceId{4}, FaceId{face_ids + 5}};
    edit.added.clear();
    add_part(script, kFollows, edited.coded(edit));
    put_seed(folder / "square", script);

    script = {std::byte{0}}; // No room.
    for (std::uint32_t i = 0; i <= kMaxRemovedBoxes; ++i)
    {
        const Vec3f corner{static_cast<float>(i), 0.0F, 0.0F};
        add_part(script, kFollows, edited.coded({i + 1, {FaceId{i}}, {}, {corner, corner}}));
    }
    put_seed(folder / "many_boxes", script);
}

constexpr tactus_v5_Placement kPlacement{{0.0, 0.0, 0.0, 1.0}, {1.0, 2.0, 3.0}, 1.0};

/// A sample, or a part of one, of zeros.
template <typename Sample>
Sample zeros()
{
    Sample sample;
    std::memset(&sample, 0, sizeof(sample));
    return sample;
}

template <std::size_t Size>
void name(char (&text)[Size], const char* name) // NOLINT: idlc's type.
{
    std::strncpy(static_cast<char*>(text), name, Size - 1);
}

tactus_v5_Telemetry telemetry_of(tactus_v5_ToolTelemetry& tool, tactus_v5_PairTelemetry& pair,
                                 tactus_v5_ModelTelemetry& model, tactus_v5_ObjectTelemetry& object)
{
    name(model.name, "tiny");
    name(object.name, "W\u00FCrfel");
    object.pose = kPlacement;
    auto sample = zeros<tactus_v5_Telemetry>();
    name(sample.controller_name, "desk");
    sample.tools = {1, 1, &tool, false};
    sample.pairs = {1, 1, &pair, false};
    sample.models = {1, 1, &model, false};
    sample.objects = {1, 1, &object, false};
    return sample;
}

void make_reports(const fs::path& folder)
{
    using fuzz::SampleKind;
    auto tool = zeros<tactus_v5_ToolTelemetry>();
    auto pair = zeros<tactus_v5_PairTelemetry>();
    auto model = zeros<tactus_v5_ModelTelemetry>();
    auto object = zeros<tactus_v5_ObjectTelemetry>();
    auto telemetry = telemetry_of(tool, pair, model, object);
    put_seed(folder / "telemetry", fuzz::sample_script(SampleKind::telemetry, telemetry));

    auto shown_tool = zeros<tactus_v5_RefinementStateTool>();
    name(shown_tool.shape, "sphere:0.002");
    auto shown_model = zeros<tactus_v5_RefinementStateModel>();
    shown_model.pages = 2;
    shown_model.requested = 1;
    auto region = zeros<tactus_v5_RefinementStateRegion>();
    std::uint32_t chunks[] = {1, 4};
    std::uint64_t refined[] = {1, 2};
    std::uint32_t requested[] = {2};
    auto state = zeros<tactus_v5_RefinementState>();
    state.tools = {1, 1, &shown_tool, false};
    state.models = {1, 1, &shown_model, false};
    state.chunks = {2, 2, chunks, false};
    state.refined = {2, 2, refined, false};
    state.requested = {1, 1, requested, false};
    state.regions = {1, 1, &region, false};
    telemetry.refinement_state = {1, 1, &state, false};
    put_seed(folder / "refinement_state", fuzz::sample_script(SampleKind::telemetry, telemetry));
}

void make_samples(const fs::path& folder)
{
    using fuzz::SampleKind;
    auto entry = zeros<tactus_v5_CatalogueEntry>();
    name(entry.name, "tiny");
    name(entry.scene, "room");
    put_seed(folder / "catalogue_entry", fuzz::sample_script(SampleKind::catalogue_entry, entry));

    auto record = zeros<tactus_v5_ObjectRecord>();
    name(record.name, "tiny");
    record.static_friction = 0.5;
    record.dynamic_friction = 0.25;
    record.texture_height_m = 0.0001;
    record.texture_length_m = 0.01;
    record.pose = kPlacement;
    put_seed(folder / "object_record", fuzz::sample_script(SampleKind::object_record, record));

    tactus_v5_MovedObject moved[2];
    std::memset(moved, 0, sizeof moved); // Seeds hold the padding, too.
    moved[1].object = 1;
    moved[0].generation = moved[1].generation = 1;
    moved[0].pose = moved[1].pose = kPlacement;
    auto motion = zeros<tactus_v5_Motion>();
    motion.moved = {2, 2, moved, false};
    put_seed(folder / "motion", fuzz::sample_script(SampleKind::motion, motion));

    const std::uint8_t content[] = {1, 2, 3};
    Bytes frames;
    for (std::uint32_t number = 0; number < 2; ++number)
    {
        dds::append_piece(frames, {{}, 0, 2, number}, std::as_bytes(std::span(content)));
    }
    const auto octets = [](Bytes& bytes)
    {
        const auto size = static_cast<std::uint32_t>(bytes.size());
        return dds_sequence_octet{size, size, reinterpret_cast<std::uint8_t*>(bytes.data()), false};
    };
    auto pieces = zeros<tactus_v5_Pieces>();
    pieces.payload = octets(frames);
    put_seed(folder / "pieces", fuzz::sample_script(SampleKind::pieces, pieces));

    const EditedModel edited;
    Bytes coded = edited.coded(edited.square());
    auto edits = zeros<tactus_v5_Edits>();
    edits.to = 1;
    edits.index = 1;
    edits.parts = 1;
    edits.payload = octets(coded);
    put_seed(folder / "edits_single", fuzz::sample_script(SampleKind::edits, edits));
    edits.to = 9;
    edits.index = dds::kKeptEdits;
    edits.parts = 2;
    put_seed(folder / "edits_sum", fuzz::sample_script(SampleKind::edits, edits));

    tactus_v5_HullVertex hull[] = {
        {{0.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}, {{0.0, 0.0, 1.0}}};
    auto request = zeros<tactus_v5_EditRequests>();
    request.from = request.to = kPlacement;
    request.hull = {4, 4, hull, false};
    put_seed(folder / "edit_requests_hull",
             fuzz::sample_script(SampleKind::edit_requests, request));
    request.hull = {0, 0, hull, false};
    request.kind = 2;
    request.radius_m = 0.002;
    request.half_axis_m[0] = 0.01;
    request.amount_m = 0.001;
    put_seed(folder / "edit_requests_capsule",
             fuzz::sample_script(SampleKind::edit_requests, request));
    make_reports(folder);
}

/// Requests of all pieces of two models of 200 and of 70 records, with credit for one after the
/// other.
void make_piece_requests(const fs::path& folder)
{
    constexpr unsigned kSends = 1;
    tactus_v5_PieceName pieces[16];
    std::memset(pieces, 0, sizeof pieces); // Seeds hold the padding, too.
    std::uint32_t count = 0;
    for (std::uint16_t model = 0; model < 2; ++model)
    {
        const std::uint32_t chunks = model == 0 ? 4 : 2;
        for (std::uint8_t kind = 0; kind < 4; ++kind)
        {
            for (std::uint32_t number = 0; number < (kind == 2 ? chunks : 1U); ++number)
            {
                pieces[count].model = model;
                pieces[count].kind = kind;
                pieces[count].number = number;
                ++count;
            }
        }
    }
    auto wanted = zeros<tactus_v5_Wanted>();
    name(wanted.controller_name, "desk");
    wanted.generation = 1;
    wanted.objects = 1;
    wanted.pieces = {count, count, pieces, false};
    Bytes script;
    const auto add = [&](unsigned control)
    {
        Bytes sample;
        fuzz::append_sample(sample, wanted);
        add_part(script, control, sample);
    };
    add(0); // There is no credit yet.
    wanted.granted = 3;
    add(kSends);
    wanted.seen = wanted.received = 3;
    wanted.granted = 128;
    wanted.pieces = {0, 0, pieces, false};
    add(kSends);
    put_seed(folder / "all_pieces", script);

    script.clear();
    wanted.seen = wanted.received = 1'000; // The server took the controller for gone.
    wanted.granted = 1'128;
    wanted.pieces = {4, 4, pieces, false};
    add(kSends);
    wanted.generation = 0;
    wanted.pieces = {1, 1, pieces + 3, false};
    add(kSends);
    put_seed(folder / "known_before", script);

    script.clear();
    wanted.seen = wanted.received = 0; // Nothing arrives.
    wanted.granted = UINT64_MAX;
    wanted.pieces = {count, count, pieces, false};
    for (std::uint32_t sent = 0; sent <= dds::kCreditPieces; sent += count)
    {
        add(kSends);
    }
    put_seed(folder / "credit_used_up", script);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fputs("usage: make_corpus FOLDER\n", stderr);
        return 3;
    }
    const fs::path folder = argv[1];
    make_models(folder / "spm_reader");
    make_recordings(folder / "recording");
    make_edits(folder / "edit");
    make_samples(folder / "dds_samples");
    make_piece_requests(folder / "piece_requests");
    put_seed(folder / "udp_session" / "version_2", conversation(udp::kVersion));
    put_seed(folder / "udp_session" / "version_1", conversation(udp::kVersionOfPoints));
    return 0;
}
