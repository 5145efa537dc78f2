// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording.hpp"
#include "platform/recording/recording_format.hpp"
#include "platform/recording/replay.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/limits.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace tactus::test
{
namespace
{

constexpr ContentKey kChunk{ContentKind::chunk, 1};

const TinyModel& model()
{
    static const TinyModel made = make_tiny_model({});
    return made;
}

std::vector<std::byte> example(std::uint64_t lost_from = kNoFrame)
{
    return example_recording(model(), lost_from);
}

std::string refusal_of(std::span<const std::byte> bytes)
{
    const auto recording = Recording::parse(bytes, "run.rec");
    return recording ? "" : recording.error().text;
}

void expect_refusal(std::span<const std::byte> bytes, const std::string& said)
{
    const std::string text = refusal_of(bytes);
    EXPECT_EQ(text.rfind("run.rec: at byte ", 0), 0U) << text;
    EXPECT_NE(text.find(said), std::string::npos) << text << "\nwithout: " << said;
    EXPECT_EQ(text.find('\n'), std::string::npos);
}

std::vector<std::size_t> sections_of(std::span<const std::byte> bytes)
{
    std::vector<std::size_t> starts;
    for (std::size_t at = kRecordingPrologueBytes; at < bytes.size();)
    {
        starts.push_back(at);
        std::uint32_t size = 0;
        std::memcpy(&size, bytes.data() + at + 4, sizeof(size));
        at += kSectionHeaderBytes + size;
    }
    return starts;
}

/// Recording with another content of one section, under a valid checksum.
template <typename Change>
std::vector<std::byte> with_section(std::size_t index, Change&& change)
{
    const std::vector<std::byte> bytes = example();
    const std::vector<std::size_t> starts = sections_of(bytes);
    const auto at = static_cast<std::ptrdiff_t>(starts[index]);
    const auto end = index + 1 < starts.size() ? static_cast<std::ptrdiff_t>(starts[index + 1])
                                               : static_cast<std::ptrdiff_t>(bytes.size());
    std::vector<std::byte> payload(bytes.begin() + at + 12, bytes.begin() + end);
    change(payload);
    std::vector<std::byte> covered(bytes.begin() + at, bytes.begin() + at + 8);
    const auto size = static_cast<std::uint32_t>(payload.size());
    std::memcpy(covered.data() + 4, &size, sizeof(size));
    covered.insert(covered.end(), payload.begin(), payload.end());
    const std::uint32_t checksum = crc32c(covered);
    std::vector<std::byte> made(bytes.begin(), bytes.begin() + at);
    made.insert(made.end(), covered.begin(), covered.begin() + 8);
    const auto* first = reinterpret_cast<const std::byte*>(&checksum);
    made.insert(made.end(), first, first + sizeof(checksum));
    made.insert(made.end(), payload.begin(), payload.end());
    made.insert(made.end(), bytes.begin() + end, bytes.end());
    return made;
}

/// Recording with `values` at a place of the section's content.
std::vector<std::byte> with_bytes(std::size_t index, std::size_t at, std::vector<unsigned> values)
{
    return with_section(index,
                        [&](std::vector<std::byte>& payload)
                        {
                            for (std::size_t i = 0; i < values.size(); ++i)
                            {
                                payload[at + i] = static_cast<std::byte>(values[i]);
                            }
                        });
}

constexpr std::size_t kSetup = 0;
constexpr std::size_t kModel = 1;
constexpr std::size_t kPiece = 2;
constexpr std::size_t kFrames = 3;
constexpr std::size_t kEnd = 4;

TEST(RecordingFile, gives_back_what_was_written)
{
    const auto sut = Recording::parse(example(), "run.rec");

    ASSERT_TRUE(sut) << sut.error().text;
    const RecordedSetup& setup = sut.value().setup();
    EXPECT_EQ(setup.tools[0].stiffness_n_per_m, 500.0);
    EXPECT_EQ(setup.tools[0].torque_max_nm, 0.25);
    EXPECT_FALSE(setup.tools[0].wants_contacts);
    EXPECT_TRUE(setup.tools[0].wants_pairs);
    EXPECT_TRUE(setup.tools[0].query_only);
    EXPECT_TRUE(setup.tools[0].wants_distance);
    EXPECT_EQ(setup.tools[0].angular_stiffness_nm_per_rad, 0.75);
    EXPECT_EQ(setup.tools[0].shading_m, 0.002);
    EXPECT_EQ(setup.objects[0].model.value, 0U);
    EXPECT_EQ(setup.objects[0].material.stiffness_n_per_m, 250.0);
    EXPECT_EQ(setup.objects[0].material.static_friction, 0.5);
    EXPECT_EQ(setup.objects[0].material.dynamic_friction, 0.25);
    EXPECT_EQ(setup.objects[0].material.damping_n_s_per_m, 1.5);
    EXPECT_EQ(setup.poses[0].translation_m, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(setup.capacities.objects, 5U);
    EXPECT_EQ(setup.capacities.pairs, 2U);
    EXPECT_EQ(setup.models[0].header, model().header);
    EXPECT_EQ(setup.models[0].base, model().base);
    EXPECT_EQ(setup.models[0].capacities.pages, 4U);
    EXPECT_EQ(setup.models[0].capacities.nodes, 40U);
    EXPECT_TRUE(setup.static_when_it_fits);
    EXPECT_EQ(setup.prediction, Prediction::quadratic);
    EXPECT_EQ(setup.force_tolerance_n, 0.0625);
    EXPECT_EQ(setup.kernels, "some kernels");
    EXPECT_EQ(sut.value().frame_count(), 3U);
    EXPECT_EQ(sut.value().lost_from(), kNoFrame);
    const auto piece = sut.value().piece(0, kChunk);
    const auto original = model().piece(kChunk);
    EXPECT_TRUE(std::equal(piece.begin(), piece.end(), original.begin(), original.end()));
    EXPECT_TRUE(sut.value().piece(0, {ContentKind::chunk, 0}).empty());
}

/// Example with an additional name.
std::vector<std::byte> with_name(const RecordedName& what, const std::string& name)
{
    RecordedSetup setup = example_setup(model());
    setup.names[{RecordedName::Kind::model, 0}] = "cup";
    RecordingWriter writer(setup);
    FrameEncoder encoder;
    ExampleFrame frame;
    frame.queues.events = {};
    writer.add_frame(frame.code(encoder));
    writer.add_name(what, name);
    writer.finish(kNoFrame);
    return writer.take_bytes();
}

TEST(RecordingFile, keeps_the_names_of_models_and_of_objects_that_come_later)
{
    using Kind = RecordedName::Kind;
    const auto sut = Recording::parse(with_name({Kind::object, 4, 2}, "K\u00FCche"), "run.rec");
    ASSERT_TRUE(sut) << sut.error().text;
    const RecordedSetup& setup = sut.value().setup();
    EXPECT_EQ(setup.name_of({Kind::model, 0}), "cup");
    EXPECT_EQ(setup.name_of({Kind::object, 4, 2}), "K\u00FCche");
    EXPECT_EQ(setup.name_of({Kind::object, 4, 1}), "");
    expect_refusal(with_name({Kind::model, 0}, "pot"), "has two names");
    for (const RecordedName& none :
         {RecordedName{Kind::model, 1}, RecordedName{Kind::object, 5},
          RecordedName{Kind::model, 0, 1}, RecordedName{static_cast<Kind>(2), 0}})
    {
        expect_refusal(with_name(none, "x"),
                       "a name belongs to no model or object of the recording");
    }
    expect_refusal(with_name({Kind::object, 0}, "a\x1B[31m"),
                   "a name is not at most 63 bytes of printable characters");
}

TEST(RecordingFile, begins_with_its_magic_and_version)
{
    const std::vector<std::byte> bytes = example();
    EXPECT_EQ(std::memcmp(bytes.data(), "TACTREC\n\x0C\0\0\0", 12), 0);
}

TEST(RecordingFile, tells_from_where_frames_were_lost)
{
    const auto sut = Recording::parse(example(3), "run.rec");
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().lost_from(), 3U);
    expect_refusal(example(2), "the first lost frame is 2, but must be 3");
}

/// Recording of `of_run` frames, and `given` frames of inputs only.
Result<Recording, Refusal> with_given_frames(int of_run, int given)
{
    RecordingWriter writer(example_setup(model()));
    FrameEncoder encoder;
    ExampleFrame frame;
    frame.queues.events = {};
    for (int i = 0; i < of_run; ++i)
    {
        writer.add_frame(frame.code(encoder));
    }
    for (int i = 0; i < given; ++i)
    {
        writer.add_frame(encoder.encode_given({frame.input(), frame.queues, frame.devices}));
    }
    writer.finish(kNoFrame);
    return Recording::parse(writer.take_bytes(), "run.rec");
}

TEST(RecordingFile, of_a_run_that_failed_ends_with_the_frame_that_did)
{
    const auto sut = with_given_frames(3, 1);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_TRUE(sut.value().has_failed());
    EXPECT_TRUE(sut.value().keeps_run());
    EXPECT_EQ(sut.value().frame_count(), 4U);
    EXPECT_FALSE(with_given_frames(3, 0).value().has_failed());
    EXPECT_NE(with_given_frames(3, 2).error().text.find("frame 4 follows a failed frame"),
              std::string::npos);
}

TEST(RecordingFile, of_the_last_inputs_alone_is_no_run_and_is_not_replayed)
{
    const auto sut = with_given_frames(0, 5);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_TRUE(sut.value().has_failed());
    EXPECT_FALSE(sut.value().keeps_run());
    EXPECT_EQ(sut.value().frame_count(), 5U);
    const auto replayed = replay(sut.value());
    ASSERT_FALSE(replayed);
    EXPECT_NE(replayed.error().text.find("holds only the last 5 frames"), std::string::npos);
}

TEST(RecordingFile, is_refused_when_it_is_of_another_kind_or_version)
{
    std::vector<std::byte> bytes = example();
    bytes[8] = std::byte{2};
    expect_refusal(
        bytes,
        "at byte 8: format version 2 is from an older version of Tactus; this program reads 12");
    bytes[3] = std::byte{'X'};
    expect_refusal(bytes, "is not a Tactus recording");
    bytes = example();
    bytes[kRecordingPrologueBytes] = std::byte{7};
    expect_refusal(bytes, "section kind 7 is unknown; 1 to 6 are allowed");
    expect_refusal({}, "at byte 0: the file is empty");
}

TEST(RecordingFile, is_refused_when_sections_are_out_of_order)
{
    const std::vector<std::byte> bytes = example();
    const std::vector<std::size_t> starts = sections_of(bytes);
    const auto section = [&](std::size_t index)
    {
        const std::size_t end = index + 1 < starts.size() ? starts[index + 1] : bytes.size();
        return std::span(bytes).subspan(starts[index], end - starts[index]);
    };
    const auto joined = [&](const std::vector<std::size_t>& order)
    {
        std::vector<std::byte> made(bytes.begin(), bytes.begin() + kRecordingPrologueBytes);
        for (const std::size_t index : order)
        {
            made.insert(made.end(), section(index).begin(), section(index).end());
        }
        return made;
    };
    EXPECT_EQ(refusal_of(joined({kSetup, kModel, kPiece, kFrames, kEnd})), "");
    expect_refusal(joined({kModel, kSetup}), "out of order");
    expect_refusal(joined({kSetup, kPiece}), "out of order");
    expect_refusal(joined({kSetup, kSetup}), "out of order");
    expect_refusal(joined({kSetup, kModel, kModel}), "out of order");
    expect_refusal(joined({kSetup, kModel, kFrames, kPiece, kEnd}),
                   "frame 0 takes piece 1 of model 0 from the queues, but the piece is not in the "
                   "recording before it");
    expect_refusal(joined({kSetup, kModel, kPiece, kPiece}), "a piece is in the recording twice");
    expect_refusal(joined({kSetup, kModel, kPiece, kEnd}),
                   "the end section states 3 frames and 1 piece, but the file has 0 and 1");
}

TEST(RecordingFile, is_refused_when_a_value_is_out_of_its_range)
{
    // Content under valid checksums is also checked.
    constexpr std::size_t kTool = 26;
    constexpr std::size_t kTorque = kTool + 33;
    constexpr std::size_t kAngular = kTorque + 9;
    constexpr std::size_t kSmooth = kAngular + 8;
    constexpr std::size_t kCore = kSmooth + 8;
    constexpr std::size_t kObject = kCore + 1;
    constexpr std::size_t kSpec = kObject + 9; // After its kind, number and generation.
    constexpr std::size_t kPose = kSpec + kObjectSpecBytes;
    constexpr std::size_t kNames = kPose + kObjectPoseBytes;
    expect_refusal(with_bytes(kSetup, 0, {0, 0, 0, 0, 0, 0, 0, 0}), "the period is 0 ns; 1 to");
    expect_refusal(with_bytes(kSetup, 16, {2}), "the static mode is 2; 0 and 1 are allowed");
    expect_refusal(with_bytes(kSetup, 17, {5}), "the prediction is 5; 0 to 4 are allowed");
    expect_refusal(with_bytes(kSetup, 18, {0}), "0 tools and 1 models; 1 to 16 and 1 to 256");
    expect_refusal(with_bytes(kSetup, 18, {17}), "17 tools");
    expect_refusal(with_bytes(kSetup, 21, {9}), "9 models");
    expect_refusal(with_bytes(kSetup, 19, {6}), "6 objects and room for 5 objects and 2 pairs");
    expect_refusal(with_bytes(kSetup, 23, {0}), "room for 0");
    expect_refusal(with_bytes(kSetup, 23, {1, 0x10}), "room for 4097");
    expect_refusal(with_bytes(kSetup, 25, {0}), " and 0 pairs");
    expect_refusal(with_bytes(kSetup, 25, {65}), " and 65 pairs");
    expect_refusal(with_bytes(kSetup, kTool + 6, {0xF8, 0x7F}),
                   "tool 0 has a value out of its range"); // NaN.
    expect_refusal(with_bytes(kSetup, kTorque + 6, {0xF8, 0x7F}),
                   "tool 0 has a value out of its range");
    expect_refusal(with_bytes(kSetup, kTorque - 1, {4}), "tool 0 has an unknown core");
    expect_refusal(with_bytes(kSetup, kAngular - 1, {4}), "tool 0 has an unknown core");
    expect_refusal(with_bytes(kSetup, kAngular + 6, {0xF8, 0x7F}),
                   "tool 0 has a value out of its range");
    expect_refusal(with_bytes(kSetup, kAngular + 6, {0xF0, 0xBF}),
                   "tool 0 has a value out of its range");
    expect_refusal(with_bytes(kSetup, kSmooth + 6, {0xF8, 0x7F}),
                   "tool 0 has a value out of its range");
    expect_refusal(with_bytes(kSetup, kSmooth + 6, {0xF0, 0xBF}),
                   "tool 0 has a value out of its range");
    expect_refusal(with_bytes(kSetup, kCore, {9}), "tool 0 has an unknown core");
    expect_refusal(with_bytes(kSetup, kObject, {1}), "object 0 is out of order");
    expect_refusal(with_bytes(kSetup, kObject, {5}), "object 0 is out of order");
    expect_refusal(with_bytes(kSetup, kObject + 1, {1}), "object 0 is out of order");
    expect_refusal(with_bytes(kSetup, kSpec, {1}),
                   "object 0 refers to model 1, but the model count is 1");
    for (const std::size_t value :
         {4U, 12U, 20U, 28U, 36U, 44U, 52U}) // NaN, then a negative number.
    {
        const std::string refusal = "object 0 has a material out of its ranges";
        expect_refusal(with_bytes(kSetup, kSpec + value + 6, {0xF8, 0x7F}), refusal);
        expect_refusal(with_bytes(kSetup, kSpec + value + 6, {0xF0, 0xBF}), refusal);
    }
    expect_refusal(with_bytes(kSetup, kSpec + 20 + 6, {0xE8, 0x3F}), "0 to the static one");
    expect_refusal(with_bytes(kSetup, kPose + 6, {0xF8, 0x7F}),
                   "object 0 has a pose without a rotation");
    expect_refusal(with_bytes(kSetup, kPose + 72 + 6, {0xF0, 0x7F}),
                   "object 0 has a pose without a rotation");
    expect_refusal(with_bytes(kSetup, kPose + 96 + 6, {0, 0}),
                   "object 0 has a pose without a rotation");
    expect_refusal(
        with_section(kSetup,
                     [](auto& payload)
                     {
                         payload[kCore] = std::byte{4};
                         payload.insert(payload.begin() + kCore + 1, {std::byte{1}, {}, {}, {}});
                     }),
        "tool 0 refers to model 1, but the model count is 1");
    expect_refusal(with_section(kSetup,
                                [](auto& payload)
                                {
                                    payload[kNames] = std::byte{64};
                                    payload.resize(payload.size() + 100, std::byte{'x'});
                                }),
                   "63 printable characters");
    expect_refusal(with_bytes(kSetup, kNames + 1, {0x1B}), "63 printable characters");
    for (const double force_tolerance_n :
         {std::nextafter(kForceToleranceMax_n, 1.0), -1e-300, std::nan("")})
    {
        expect_refusal(with_section(kSetup,
                                    [&](auto& payload) {
                                        std::memcpy(payload.data() + payload.size() - 8,
                                                    &force_tolerance_n, 8);
                                    }),
                       "the force tolerance is");
    }
    expect_refusal(with_bytes(kModel, 0, {0}), "a pool has 0 slots; 1 to");
    expect_refusal(with_bytes(kModel, 0, {0, 0, 0, 0x20}), "slots; 1 to");
    expect_refusal(with_bytes(kModel, 0, {0, 0, 0, 0x02}), "more than 4096 MiB");
    expect_refusal(with_bytes(kModel, 8, {0, 0, 0, 0x01}),
                   "room for 16777216 faces; at most 16777215 are allowed");
    expect_refusal(with_bytes(kModel, 8, {1, 0}), "room for 1 faces; the base mesh alone has 8");
    expect_refusal(with_bytes(kModel, 20, {4}), "the flags of the model are 4; 0 to 3 are allowed");
    for (const std::uint32_t room : {0U, kMaxAddedFaces + 1})
    {
        expect_refusal(with_section(kModel,
                                    [&](auto& payload)
                                    {
                                        payload[20] = std::byte{2};
                                        const auto* bytes =
                                            reinterpret_cast<const std::byte*>(&room);
                                        payload.insert(payload.begin() + 21, bytes, bytes + 4);
                                    }),
                       "added faces; 1 to 262144 are allowed");
    }
    expect_refusal(with_bytes(kModel, 21, {0xFF, 0xFF, 0xFF}), "the model section has a size");
    expect_refusal(with_bytes(kModel, 25, {0}), "the model's header is damaged");
    expect_refusal(with_bytes(kPiece, 0, {1}), "a piece is neither a chunk or index page");
    expect_refusal(with_bytes(kPiece, 2, {0xFF}), "a piece is neither a chunk or index page");
    expect_refusal(with_section(kPiece, [](auto& payload) { payload.resize(6); }),
                   "a piece has 0 bytes; 1 to 8448 are allowed");
    expect_refusal(with_section(kPiece, [](auto& payload) { payload.resize(9'000); }),
                   "a piece has 8994 bytes");
    expect_refusal(with_section(kFrames, [](auto& payload) { payload.clear(); }),
                   "a frames section has 0 bytes");
    expect_refusal(with_section(kFrames, [](auto& payload) { payload.resize((1U << 20U) + 1); }),
                   "a frames section has 1048577 bytes; 1 to 1048576 are allowed");
    expect_refusal(with_section(kFrames, [](auto& payload) { payload.pop_back(); }),
                   "frame 2 is cut short by the end of its section");
    constexpr std::size_t kFeel = 9 + kObjectSpecBytes - 4; // This change names no model.
    constexpr std::size_t kChanges = 1 + 9 + kObjectPoseBytes + kSceneChangeBytes + kFeel;
    constexpr std::size_t kSlot = 4 + 1 + 8 + kToolStateBytes + kChanges + kBudgetsBytes + 13;
    expect_refusal(with_bytes(kFrames, kSlot, {4}),
                   "frame 0 refers to slot 4, but the slot count is 4");
    expect_refusal(with_bytes(kFrames, kSlot - 5, {9}), "takes piece 1 of model 9 from the queues");
    expect_refusal(with_bytes(kEnd, 0, {2}),
                   "the end section states 2 frames and 1 piece, but the file has 3 and 1");
    expect_refusal(with_section(kEnd, [](auto& payload) { payload.push_back({}); }),
                   "the end section has a size that differs from its content");
}

/// Recording of several sections of frames, with the start of its end section.
std::pair<std::vector<std::byte>, std::size_t> long_recording()
{
    RecordingWriter writer(example_setup(model()));
    FrameEncoder encoder;
    ExampleFrame frame;
    frame.queues.events = {};
    for (int i = 0; i < 1'000; ++i)
    {
        writer.add_frame(frame.code(encoder));
    }
    writer.finish(kNoFrame);
    std::vector<std::byte> bytes = writer.take_bytes();
    const std::size_t end = sections_of(bytes).back();
    return {std::move(bytes), end};
}

TEST(RecordingFile, that_was_cut_has_the_frames_up_to_its_last_whole_section)
{
    const auto [bytes, end] = long_recording();
    const std::vector<std::size_t> starts = sections_of(bytes);
    ASSERT_GE(starts.size(), 5U) << "two sections of frames at least";
    const std::uint64_t all = Recording::parse(bytes, "run.rec").value().frame_count();
    std::uint64_t before = 0;
    for (std::size_t section = 3; section < starts.size(); ++section)
    {
        const std::size_t next = section + 1 < starts.size() ? starts[section + 1] : bytes.size();
        for (const std::size_t length :
             {starts[section], starts[section] + 1, starts[section] + 11, starts[section] + 12,
              starts[section] + 13, (starts[section] + next) / 2, next - 1})
        {
            const auto sut = Recording::parse(std::span(bytes).first(length), "run.rec");
            ASSERT_TRUE(sut) << length << ": " << sut.error().text;
            EXPECT_EQ(sut.value().cut_at(), starts[section]);
            EXPECT_NE(sut.value().missing().find("the file is incomplete: after frame "),
                      std::string::npos);
            EXPECT_TRUE(sut.value().frame_count() > before || length > starts[section]);
            before = sut.value().frame_count();
            FrameDecoder decoder(sut.value().shape());
            std::uint64_t decoded = 0;
            for (ByteReader reader(sut.value().frames()); !reader.at_end(); ++decoded)
            {
                ASSERT_EQ(decoder.decode(reader), nullptr);
            }
            EXPECT_EQ(decoded, sut.value().frame_count());
        }
    }
    EXPECT_EQ(before, all);
    EXPECT_FALSE(Recording::parse(bytes, "run.rec").value().cut_at());
    EXPECT_EQ(Recording::parse(bytes, "run.rec").value().missing(), "");
    for (std::size_t section = 0; section < 3; ++section)
    {
        expect_refusal(std::span(bytes).first(starts[section]),
                       "the file is cut short: no frame is complete");
    }
}

TEST(RecordingFile, whose_end_a_file_system_lost_is_cut_where_the_zeros_begin)
{
    const auto [bytes, end] = long_recording();
    const std::vector<std::size_t> starts = sections_of(bytes);
    const std::size_t last = starts[starts.size() - 2];
    for (const std::size_t whole : {last, last + 4, last + 12, last + 700})
    {
        std::vector<std::byte> lost = bytes;
        std::fill(lost.begin() + static_cast<std::ptrdiff_t>(whole), lost.end(), std::byte{0});
        const auto sut = Recording::parse(lost, "run.rec");
        ASSERT_TRUE(sut) << sut.error().text;
        EXPECT_EQ(sut.value().cut_at(), last);
    }
    std::vector<std::byte> damaged = bytes;
    damaged[last + 100] ^= std::byte{1};
    expect_refusal(damaged, "is damaged: its checksum does not match");
    damaged.resize(end); // Also truncated: the complete part is not what it claims.
    expect_refusal(damaged, "is damaged: its checksum does not match");
    damaged = bytes;
    damaged[starts[3] + 7] = std::byte{0x7F}; // Length that no section has.
    expect_refusal(damaged, "section of kind 4 states a size of 21");
}

TEST(ToolCoreCoding, refuses_what_is_of_no_kind_or_out_of_range)
{
    HullVertices kept;
    std::vector<std::byte> segment;
    append_core(segment, Segment{Vec3(1, 2, 3), Vec3(-4, 5, -6)});
    // Infinity in the last number, then an invalid kind.
    segment[segment.size() - 1] = std::byte{0x7F};
    segment[segment.size() - 2] = std::byte{0xF0};
    ByteReader infinite(segment);
    EXPECT_FALSE(read_core(infinite, kept));
    segment[0] = std::byte{5};
    ByteReader unknown(segment);
    EXPECT_FALSE(read_core(unknown, kept));
    for (const std::uint8_t count : {std::uint8_t{0}, std::uint8_t{65}})
    {
        std::vector<std::byte> bytes(2 + 65 * 24, std::byte{0});
        bytes[0] = std::byte{3};
        bytes[1] = std::byte{count};
        ByteReader reader(bytes);
        EXPECT_FALSE(read_core(reader, kept)) << int{count};
    }
    std::vector<std::byte> negative;
    append_core(negative, Box{Vec3(0.5, -1.0, 2.0)});
    ByteReader reader(negative);
    EXPECT_FALSE(read_core(reader, kept));
}

TEST(RecordingFile, that_is_missing_or_a_folder_is_refused)
{
    const TemporaryFolder folder;
    const std::string missing = (folder.path() / "missing.rec").string();
    const auto absent = Recording::read(missing);
    ASSERT_FALSE(absent);
    EXPECT_EQ(absent.error().text.rfind(missing + ": cannot be opened: ", 0), 0U);
    const auto directory = Recording::read(folder.path().string());
    ASSERT_FALSE(directory);
    EXPECT_NE(directory.error().text.find("is not a file but a directory"), std::string::npos);
    const auto whole = Recording::read(folder.write("run.rec", example()).string());
    EXPECT_TRUE(whole) << whole.error().text;
}

} // namespace
} // namespace tactus::test
