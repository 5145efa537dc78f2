// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_decoder.hpp"

#include "platform/recording/frame_encoder.hpp"

#include <cmath>

namespace tactus
{

namespace
{

Vec3 read_vector(ByteReader& reader)
{
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis)
    {
        value[axis] = reader.read<double>();
    }
    return value;
}

Mat3 read_rotation(ByteReader& reader)
{
    Mat3 rotation;
    for (int row = 0; row < 3; ++row)
    {
        rotation.row(row) = read_vector(reader).transpose();
    }
    return rotation;
}

ObjectPose read_pose(ByteReader& reader)
{
    ObjectPose pose;
    pose.rotation = read_rotation(reader);
    pose.translation_m = read_vector(reader);
    pose.scale = reader.read<double>();
    pose.stamp_ns = reader.read<std::int64_t>();
    pose.age_ns = reader.read<std::int64_t>();
    pose.revision = reader.read<std::uint32_t>();
    return pose;
}

Budgets read_budgets(ByteReader& reader)
{
    Budgets budgets;
    for (std::uint32_t* budget :
         {&budgets.splits, &budgets.merges, &budgets.scanned, &budgets.nodes, &budgets.triangles,
          &budgets.pages, &budgets.requests, &budgets.regions})
    {
        *budget = reader.read<std::uint32_t>();
    }
    return budgets;
}

} // namespace

FrameDecoder::FrameDecoder(const FrameShape& shape)
{
    frame_.tools.resize(shape.tools);
    frame_.poses.resize(shape.objects);
    frame_.doors.resize(shape.models);
    frame_.state_hashes.resize(shape.models);
}

const char* FrameDecoder::decode(ByteReader& reader)
{
    const auto bytes = reader.read<std::uint32_t>();
    ByteReader body(reader.read_bytes(bytes));
    if (reader.failed())
    {
        return "is cut short by the end of its section";
    }
    if (const char* fault = decode_body(body))
    {
        return fault;
    }
    return body.failed() || !body.at_end() ? "has another size than its content" : nullptr;
}

const char* FrameDecoder::decode_body(ByteReader& reader)
{
    const auto flags = reader.read<std::uint8_t>();
    if (flags > (kHasPoses | kHasBudgets) || (!has_begun_ && flags != (kHasPoses | kHasBudgets)))
    {
        return "has flags that are not 0 to 3, or not 3 in the first frame";
    }
    has_begun_ = true;
    if (!decode_tools(reader))
    {
        return "has a tool whose validity is not 0 or 1";
    }
    if ((flags & kHasPoses) != 0 && !decode_poses(reader))
    {
        return "has a pose that is not finite or whose scale is not above 0";
    }
    if ((flags & kHasBudgets) != 0)
    {
        frame_.budgets = read_budgets(reader);
        if (frame_.budgets.splits > kMaxSplitsPerFrame ||
            frame_.budgets.merges > kMaxMergesPerFrame)
        {
            return "allows more than 256 splits or merges";
        }
    }
    for (RecordedFrame::Door& door : frame_.doors)
    {
        if (const char* fault = decode_door(reader, door))
        {
            return fault;
        }
    }
    for (std::uint64_t& hash : frame_.state_hashes)
    {
        hash = reader.read<std::uint64_t>();
    }
    for (std::uint64_t* hash :
         {&frame_.output.tools, &frame_.output.pairs, &frame_.output.models, &frame_.output.work})
    {
        *hash = reader.read<std::uint64_t>();
    }
    return nullptr;
}

const char* FrameDecoder::decode_door(ByteReader& reader, RecordedFrame::Door& door)
{
    door.wish_room = reader.read<std::uint32_t>();
    const auto events = reader.read<std::uint16_t>();
    if (events > kMaxDoorEvents)
    {
        return "takes more than 128 events from a door";
    }
    door.events.resize(events);
    for (DoorEvent& event : door.events)
    {
        const auto kind = reader.read<std::uint8_t>();
        const auto content = reader.read<std::uint8_t>();
        event.key.number = reader.read<std::uint32_t>();
        event.slot = reader.read<std::uint32_t>();
        event.freed_taken = reader.read<std::uint32_t>();
        event.linked = reader.read<std::uint64_t>();
        event.kind = static_cast<DoorEventKind>(kind);
        event.key.kind = static_cast<ContentKind>(content);
        const bool is_known =
            event.kind == DoorEventKind::arrival
                ? event.key.kind == ContentKind::chunk || event.key.kind == ContentKind::index_page
                : event.kind == DoorEventKind::link_update && event.key.kind == ContentKind::chunk;
        if (!reader.failed() && !is_known)
        {
            return "takes an event of unknown kind from a door";
        }
    }
    return nullptr;
}

bool FrameDecoder::decode_tools(ByteReader& reader)
{
    bool is_sound = true;
    for (ToolState& tool : frame_.tools)
    {
        tool.position_m = read_vector(reader);
        tool.sample_time_ns = reader.read<std::int64_t>();
        tool.elapsed_periods = reader.read<std::uint32_t>();
        const auto flags = reader.read<std::uint8_t>();
        tool.valid = (flags & kIsValid) != 0;
        tool.rotation = Mat3::Identity();
        if ((flags & kHasRotation) != 0)
        {
            tool.rotation = read_rotation(reader);
        }
        is_sound = is_sound && flags <= (kIsValid | kHasRotation);
    }
    return is_sound;
}

bool FrameDecoder::decode_poses(ByteReader& reader)
{
    bool is_sound = true;
    for (ObjectPose& pose : frame_.poses)
    {
        pose = read_pose(reader);
        is_sound = is_sound && (reader.failed() ||
                                (pose.rotation.allFinite() && pose.translation_m.allFinite() &&
                                 std::isfinite(pose.scale) && pose.scale > 0.0));
    }
    return is_sound;
}

} // namespace tactus
