// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/codec/decoders.hpp"

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/piece_coding.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/fuzz/model_laws.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/seal_model.hpp"
#include "tests/unit/platform/example_datagrams.hpp"
#include "tests/unit/recording/recorded_example.hpp"
#include "transport/dds/piece_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::codec
{

namespace
{

using fuzz::is_clear_refusal;

/// Two chunks, the second one with 36 records.
const test::TinyModel& sample_model()
{
    static const test::TinyModel made = test::make_tiny_model({.records = 100});
    return made;
}

const ModelHeader& sample_header()
{
    static const ModelHeader header = ModelHeader::parse(sample_model().header).value();
    return header;
}

template <typename T>
Reading told(const Result<T, SpmRefusal>& result, bool is_lawful)
{
    return result ? Reading{"", is_lawful} : Reading{refusal_text(result.error())};
}

Reading read_header(View bytes)
{
    const auto header = ModelHeader::parse(bytes);
    return told(header, header && fuzz::is_lawful_header(header.value(), bytes));
}

Reading read_base(View bytes)
{
    const ModelCounts counts = sample_header().counts();
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    const BaseMesh mesh{positions_m, faces, next};
    const auto done = parse_base_mesh(bytes, sample_header(), mesh);
    if (!done)
    {
        return told(done, false);
    }
    std::vector<GridPosition> positions;
    for (const Vec3f& p : positions_m)
    {
        const auto quanta = [](float x)
        { return static_cast<std::int32_t>(x / sample_header().quantum_m()); };
        positions.push_back({quanta(p[0]), quanta(p[1]), quanta(p[2])});
    }
    const Bytes again = encode_base_mesh(positions, faces, BaseLayout(sample_header().fields()));
    // The last byte of the fields has bits that belong to no field; a reader ignores them.
    const std::size_t whole = bytes.size() - kChecksumBytes - 1;
    return told(done, fuzz::is_lawful_base(sample_header(), mesh) &&
                          std::ranges::equal(View(again).first(whole), bytes.first(whole)));
}

Reading read_index_page(View bytes)
{
    const ModelCounts counts = sample_header().counts();
    IndexPage page;
    std::vector<ChunkEntry> entries(kChunksPerIndexPage);
    const auto done = parse_index_page(bytes, counts, {0}, page, entries);
    return told(done, fuzz::is_lawful_index_page(counts, {0}, page, entries));
}

Reading read_chunk(View bytes)
{
    Page page;
    const auto done = parse_chunk(bytes, sample_header(), {1}, page);
    return told(done, fuzz::is_lawful_parsed_page(sample_header(), {1}, page));
}

/// Fault of the file as a whole, or of one damaged chunk, in one clear line.
Reading read_model_file(View bytes)
{
    static fuzz::ScratchFile file("model.spm");
    file.replace(bytes);
    const std::string start = file.path().string() + ": ";
    const auto store = ModelStore::open(file.path());
    if (!store)
    {
        return {store.error().text, is_clear_refusal(store.error().text, start)};
    }
    std::vector<std::string> damage;
    static_cast<void>(DecodedModel::decode(store.value(), damage));
    return damage.empty() ? Reading{}
                          : Reading{damage[0], damage.size() == 1 &&
                                                   is_clear_refusal(damage[0], start + "chunk ") &&
                                                   damage[0].find(" at offset ") < 1'000};
}

Reading read_recording(View bytes)
{
    const auto recording = Recording::parse(bytes, "run.rec");
    if (recording)
    {
        // A recording that was cut after its first frames is read up to there and reports it.
        return {recording.value().missing(), true};
    }
    return {recording.error().text, is_clear_refusal(recording.error().text, "run.rec: at byte ")};
}

std::vector<Bytes> frame_samples()
{
    FrameEncoder encoder;
    return {test::ExampleFrame().code(encoder)};
}

void fit_frame_size(std::span<std::byte> bytes)
{
    if (const auto size = static_cast<std::uint32_t>(bytes.size()) - 4; bytes.size() >= 4)
    {
        std::memcpy(bytes.data(), &size, sizeof(size));
    }
}

/// Frames in the order of a recording, up to the last. The output hashes that close a frame are the
/// encoder's own.
Reading read_frames(View bytes)
{
    FrameDecoder decoder(test::kExampleShape);
    ByteReader reader(bytes);
    do
    {
        if (const char* fault = decoder.decode(reader))
        {
            return {fault};
        }
    } while (!reader.at_end());
    const RecordedFrame& frame = decoder.frame();
    const QueueTake queues{frame.events, frame.request_room};
    ModelOutput model;
    model.state_hash = frame.state_hashes[0];
    FrameEncoder encoder;
    const auto again = encoder.encode(
        frame.input(), {{}, {}, {&model, 1}, {}, FrameFault::none, queues, {}}, frame.devices);
    const std::size_t told = again.size() - sizeof(OutputHashes);
    return {"", again.size() == bytes.size() &&
                    std::ranges::equal(again.first(told), bytes.first(told)) &&
                    std::memcmp(&frame.output, &bytes[told], sizeof(OutputHashes)) == 0};
}

std::vector<Bytes> core_samples()
{
    const std::array<Vec3, 4> vertices{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)};
    std::vector<Bytes> samples;
    for (const ToolCore& core :
         {ToolCore(PointCore{}), ToolCore(Segment{Vec3(1, 2, 3), Vec3(-4, 5, -6)}),
          ToolCore(Box{Vec3(0.5, 0.0, 2.0)}), ToolCore(Hull::create(vertices).value()),
          ToolCore(MeshCore{ModelId{3}, Vec3(0, 0, 0), Vec3(0, 0, 0)})})
    {
        append_core(samples.emplace_back(), core);
    }
    return samples;
}

Reading read_whole_core(View bytes)
{
    HullVertices kept;
    ByteReader reader(bytes);
    const auto core = read_core(reader, kept);
    if (!core || reader.failed() || !reader.at_end())
    {
        return {"is no core"};
    }
    Bytes again;
    append_core(again, *core);
    return {"", std::ranges::equal(again, bytes)};
}

template <typename Datagram>
Bytes bytes_of(const Datagram& datagram)
{
    const auto bytes = udp::encode(datagram);
    return {bytes.begin(), bytes.end()};
}

template <typename Datagram>
Datagram of_points(Datagram datagram)
{
    datagram.version = udp::kVersionOfPoints;
    return datagram;
}

template <typename Datagram>
Reading told(const Datagram& datagram, View bytes)
{
    return {"", std::ranges::equal(udp::encode(datagram), bytes)};
}

/// Values without their flag are not read, so they do not come back.
Reading told(const udp::SampleDatagram& sample, View bytes)
{
    const bool turns = sample.rotation && sample.angular_velocity_rad_per_s && sample.gripper_m;
    const bool has_all = sample.valid && sample.velocity_m_per_s &&
                         (turns || sample.version == udp::kVersionOfPoints);
    const auto is_in_range = [](double x) { return std::abs(x) <= 1e6; };
    return {"", sample.time_ns >= 0 && std::ranges::all_of(sample.position_m, is_in_range) &&
                    (!has_all || std::ranges::equal(udp::encode(sample), bytes))};
}

Reading told(udp::DatagramFault fault, View /*bytes*/)
{
    return {std::string(text_of(fault))};
}

udp::FromDevice decode_from_device(View bytes)
{
    return udp::decode_from_device(bytes);
}

template <auto decode>
Reading read_datagram(View bytes)
{
    return std::visit([&](const auto& decoded) { return told(decoded, bytes); }, decode(bytes));
}

constexpr std::size_t kFirstPieceBytes = 11;

Bytes sample_payload()
{
    Bytes payload;
    dds::append_piece(payload, {{1, 2, 3}, 7, 2, 40}, Bytes(kFirstPieceBytes, std::byte{1}));
    dds::append_piece(payload, {{1, 2, 3}, 7, 1, 41}, Bytes(3, std::byte{2}));
    return payload;
}

Reading read_payload(View bytes)
{
    dds::PieceReader reader(bytes);
    Bytes again;
    while (const auto piece = reader.next())
    {
        dds::append_piece(again, piece->key, piece->bytes);
    }
    return {reader.is_broken() ? "is broken" : "",
            std::equal(again.begin(), again.end(), bytes.begin()) &&
                (reader.is_broken() || again.size() == bytes.size())};
}

template <typename... Sample>
std::vector<Bytes> list(const Sample&... samples)
{
    return {Bytes(samples)...};
}

} // namespace

std::vector<Decoder> all_decoders()
{
    const std::string too_short = refusal_text(SpmRefusal::too_short);
    const std::string trailing = refusal_text(SpmRefusal::trailing_bytes);
    const std::string wrong_size(text_of(udp::DatagramFault::size));
    const std::string version(text_of(udp::DatagramFault::version));
    return {
        {"model_header",
         [] { return list(sample_model().header); },
         read_header,
         too_short,
         trailing,
         fuzz::seal_piece,
         {8, 9, 10, 11},
         refusal_text(SpmRefusal::unknown_version)},
        {"base_mesh", [] { return list(sample_model().base); }, read_base, too_short, trailing,
         fuzz::seal_piece},
        {"index_page", [] { return sample_model().index_pages; }, read_index_page, too_short,
         trailing, fuzz::seal_piece},
        {.name = "chunk",
         .samples = [] { return list(sample_model().chunks[1]); },
         .read = read_chunk,
         .followed = trailing,
         .seal = [](std::span<std::byte> bytes) { fuzz::seal_chunk(bytes, {1}); },
         .tells_its_size = false},
        {"model_file",
         [] { return list(sample_model().file); },
         read_model_file,
         "",
         "followed by other bytes",
         nullptr,
         {8, 9, 10, 11},
         "has format version"},
        {"recording",
         [] { return list(test::example_recording(test::make_tiny_model({}))); },
         read_recording,
         "the file ", // The file is truncated or empty, or was cut after the first frames.
         "after the end section, which must be the last",
         nullptr,
         {8, 9, 10, 11},
         "format version"},
        {.name = "recorded_frame",
         .samples = frame_samples,
         .read = read_frames,
         .followed = "has a size that differs from its content",
         .seal = fit_frame_size,
         .sees_every_flip = false},
        {.name = "tool_core",
         .samples = core_samples,
         .read = read_whole_core,
         .sees_every_flip = false},
        {"datagram_from_device",
         []
         {
             return list(bytes_of(test::example_description()), bytes_of(test::example_sample()),
                         bytes_of(of_points(test::example_description())),
                         bytes_of(of_points(test::example_sample())));
         },
         read_datagram<decode_from_device>,
         wrong_size,
         wrong_size,
         fuzz::seal_piece,
         {4, 5},
         version,
         {1, 2}},
        {"datagram_from_controller",
         [] {
             return list(bytes_of(test::example_force()),
                         bytes_of(of_points(test::example_force())));
         },
         read_datagram<udp::decode_from_controller>,
         wrong_size,
         wrong_size,
         fuzz::seal_piece,
         {4, 5},
         version,
         {1, 2}},
        {.name = "payload_of_pieces",
         .samples = [] { return list(sample_payload()); },
         .read = read_payload,
         .sees_every_flip = false,
         .whole_at = {0, dds::kFrameBytes + kFirstPieceBytes}},
    };
}

} // namespace tactus::codec
