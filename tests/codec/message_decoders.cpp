// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/core_coding.hpp"
#include "platform/recording/recording.hpp"
#include "tests/codec/decoders.hpp"
#include "tests/fuzz/law.hpp"
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

std::vector<Bytes> sample_recordings()
{
    return {test::example_recording(test::make_tiny_model({}))};
}

Reading read_recording(std::span<const std::byte> bytes)
{
    const auto recording = Recording::parse(bytes, "run.rec");
    if (recording)
    {
        return {};
    }
    const std::string& text = recording.error().text;
    return {text, fuzz::is_clear_refusal(text, "run.rec: at byte ")};
}

std::vector<Bytes> sample_frames()
{
    const test::ExampleFrame frame;
    FrameEncoder encoder;
    return {frame.code(encoder)};
}

void fit_frame_size(std::span<std::byte> bytes)
{
    if (const std::uint32_t size = static_cast<std::uint32_t>(bytes.size()) - 4; bytes.size() >= 4)
    {
        std::memcpy(bytes.data(), &size, sizeof(size));
    }
}

/// As a recording reads them, until none is left.
Reading read_frames(std::span<const std::byte> bytes)
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
    const DoorTake door{frame.doors[0].events, frame.doors[0].wish_room};
    ModelOutput model;
    model.state_hash = frame.state_hashes[0];
    FrameEncoder encoder;
    const auto again = encoder.encode(frame.tools, frame.poses, frame.budgets,
                                      {{}, {}, {&model, 1}, {}, FrameFault::none, {&door, 1}});
    // The output's hashes close a frame; the encoder makes them of an output.
    const std::size_t told = again.size() - sizeof(OutputHashes);
    return {"", again.size() == bytes.size() &&
                    std::ranges::equal(again.first(told), bytes.first(told)) &&
                    std::memcmp(&frame.output, &bytes[told], sizeof(OutputHashes)) == 0};
}

std::vector<Bytes> sample_cores()
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

Reading read_whole_core(std::span<const std::byte> bytes)
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

std::vector<Bytes> samples_from_device()
{
    return {bytes_of(test::example_description()), bytes_of(test::example_sample())};
}

std::vector<Bytes> samples_from_controller()
{
    return {bytes_of(test::example_force())};
}

template <typename Datagram>
Reading reading_of(const Datagram& datagram, std::span<const std::byte> bytes)
{
    return {"", std::ranges::equal(udp::encode(datagram), bytes)};
}

/// Without its flag a position or velocity isn't looked at, so it doesn't come back.
Reading reading_of(const udp::SampleDatagram& sample, std::span<const std::byte> bytes)
{
    const bool has_all = sample.valid && sample.velocity_m_per_s;
    const bool is_in_range =
        sample.time_ns >= 0 &&
        std::ranges::all_of(sample.position_m, [](double x) { return std::abs(x) <= 1e6; });
    return {"", is_in_range && (!has_all || std::ranges::equal(udp::encode(sample), bytes))};
}

Reading reading_of(udp::DatagramFault fault, std::span<const std::byte> /*bytes*/)
{
    return {std::string(text_of(fault))};
}

Reading read_from_device(std::span<const std::byte> bytes)
{
    return std::visit([&](const auto& decoded) { return reading_of(decoded, bytes); },
                      udp::decode_from_device(bytes));
}

Reading read_from_controller(std::span<const std::byte> bytes)
{
    return std::visit([&](const auto& decoded) { return reading_of(decoded, bytes); },
                      udp::decode_from_controller(bytes));
}

constexpr std::size_t kFirstPieceBytes = 11;

std::vector<Bytes> sample_payloads()
{
    Bytes payload;
    dds::append_piece(payload, {{1, 2, 3}, 7, 2, 40}, Bytes(kFirstPieceBytes, std::byte{1}));
    dds::append_piece(payload, {{1, 2, 3}, 7, 1, 41}, Bytes(3, std::byte{2}));
    return {payload};
}

Reading read_payload(std::span<const std::byte> bytes)
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

} // namespace

std::vector<Decoder> message_decoders()
{
    const std::string wrong_size(text_of(udp::DatagramFault::size));
    const std::string wrong_version(text_of(udp::DatagramFault::version));
    return {{.name = "recording",
             .samples = sample_recordings,
             .read = read_recording,
             .cut = "the file is ", // Cut short or empty.
             .followed = "bytes; nothing may follow it",
             .version_at = {8, 9, 10, 11},
             .unknown_version = "format version "},
            {.name = "recorded_frame",
             .samples = sample_frames,
             .read = read_frames,
             .cut = "",
             .followed = "has another size than its content",
             .sees_every_flip = false,
             .seal = fit_frame_size},
            {.name = "tool_core",
             .samples = sample_cores,
             .read = read_whole_core,
             .cut = "",
             .followed = "",
             .sees_every_flip = false},
            {.name = "datagram_from_device",
             .samples = samples_from_device,
             .read = read_from_device,
             .cut = wrong_size,
             .followed = wrong_size,
             .seal = fuzz::seal_piece,
             .version_at = {4, 5},
             .unknown_version = wrong_version},
            {.name = "datagram_from_controller",
             .samples = samples_from_controller,
             .read = read_from_controller,
             .cut = wrong_size,
             .followed = wrong_size,
             .seal = fuzz::seal_piece,
             .version_at = {4, 5},
             .unknown_version = wrong_version},
            {.name = "payload_of_pieces",
             .samples = sample_payloads,
             .read = read_payload,
             .cut = "",
             .followed = "",
             .whole_at = {0, dds::kFrameBytes + kFirstPieceBytes},
             .sees_every_flip = false}};
}

} // namespace tactus::codec
