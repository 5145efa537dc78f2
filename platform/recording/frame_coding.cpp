// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_coding.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus
{

namespace
{

constexpr std::uint8_t kHasPoses = 1;
constexpr std::uint8_t kHasBudgets = 2;

/// Writes into memory of fixed size, whose sizes above leave room for everything.
class FixedWriter
{
public:
    explicit FixedWriter(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

    template <typename T>
    void write(const T& value) noexcept
    {
        static_assert(std::is_arithmetic_v<T>);
        TACTUS_ASSERT(bytes_.size() - at_ >= sizeof(T));
        std::memcpy(bytes_.data() + at_, &value, sizeof(T));
        at_ += sizeof(T);
    }
    void write_bytes(std::span<const std::byte> bytes) noexcept
    {
        TACTUS_ASSERT(bytes_.size() - at_ >= bytes.size());
        std::memcpy(bytes_.data() + at_, bytes.data(), bytes.size());
        at_ += bytes.size();
    }
    void write_vector(const Vec3& value) noexcept
    {
        write(value.x());
        write(value.y());
        write(value.z());
    }
    [[nodiscard]] std::size_t size() const noexcept { return at_; }

private:
    std::span<std::byte> bytes_;
    std::size_t at_{0};
};

void write_tool(FixedWriter& writer, const ToolState& tool) noexcept
{
    writer.write_vector(tool.position_m);
    writer.write(tool.sample_time_ns);
    writer.write(tool.elapsed_periods);
    writer.write(static_cast<std::uint8_t>(tool.valid));
}

void write_pose(FixedWriter& writer, const ObjectPose& pose) noexcept
{
    for (int row = 0; row < 3; ++row)
    {
        writer.write_vector(pose.rotation.row(row).transpose());
    }
    writer.write_vector(pose.translation_m);
    writer.write(pose.scale);
    writer.write(pose.stamp_ns);
    writer.write(pose.age_ns);
    writer.write(pose.revision);
}

void write_budgets(FixedWriter& writer, const Budgets& budgets) noexcept
{
    for (const std::uint32_t budget :
         {budgets.splits, budgets.merges, budgets.scanned, budgets.nodes, budgets.triangles,
          budgets.pages, budgets.requests, budgets.regions})
    {
        writer.write(budget);
    }
}

void write_door(FixedWriter& writer, const DoorTake& door) noexcept
{
    writer.write(door.wish_room);
    writer.write(static_cast<std::uint16_t>(door.events.size()));
    for (const DoorEvent& event : door.events)
    {
        writer.write(static_cast<std::uint8_t>(event.kind));
        writer.write(static_cast<std::uint8_t>(event.key.kind));
        writer.write(event.key.number);
        writer.write(event.slot);
        writer.write(event.freed_taken);
        writer.write(event.linked);
    }
}

/// Copies `now` over `last`; whether they differed.
bool try_update(std::span<const std::byte> now, std::span<std::byte> last) noexcept
{
    if (std::memcmp(now.data(), last.data(), now.size()) == 0)
    {
        return false;
    }
    std::memcpy(last.data(), now.data(), now.size());
    return true;
}

Vec3 read_vector(ByteReader& reader)
{
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis)
    {
        value[axis] = reader.read<double>();
    }
    return value;
}

ObjectPose read_pose(ByteReader& reader)
{
    ObjectPose pose;
    for (int row = 0; row < 3; ++row)
    {
        pose.rotation.row(row) = read_vector(reader).transpose();
    }
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

std::span<const std::byte> FrameEncoder::encode(std::span<const ToolState> tools,
                                                std::span<const ObjectPose> poses,
                                                const Budgets& budgets,
                                                const FrameOutput& output) noexcept
{
    std::array<std::byte, kMaxObjects * kObjectPoseBytes> coded_poses;
    FixedWriter pose_writer(coded_poses);
    for (const ObjectPose& pose : poses)
    {
        write_pose(pose_writer, pose);
    }
    const std::span<const std::byte> now(coded_poses.data(), pose_writer.size());
    std::array<std::byte, kBudgetsBytes> coded_budgets;
    FixedWriter budget_writer(coded_budgets);
    write_budgets(budget_writer, budgets);
    const bool has_poses = try_update(now, poses_) || !has_begun_;
    const bool has_budgets = try_update(coded_budgets, budgets_) || !has_begun_;
    has_begun_ = true;

    FixedWriter writer{std::span(bytes_).subspan(sizeof(std::uint32_t))};
    writer.write(
        static_cast<std::uint8_t>((has_poses ? kHasPoses : 0) | (has_budgets ? kHasBudgets : 0)));
    for (const ToolState& tool : tools)
    {
        write_tool(writer, tool);
    }
    writer.write_bytes(has_poses ? now : std::span<const std::byte>{});
    writer.write_bytes(has_budgets ? std::span<const std::byte>(coded_budgets)
                                   : std::span<const std::byte>{});
    for (const DoorTake& door : output.door)
    {
        write_door(writer, door);
    }
    for (const ModelOutput& model : output.models)
    {
        writer.write(model.state_hash);
    }
    const OutputHashes hashes = hash_output(output);
    for (const std::uint64_t hash : {hashes.tools, hashes.pairs, hashes.models, hashes.work})
    {
        writer.write(hash);
    }
    FixedWriter(bytes_).write(static_cast<std::uint32_t>(writer.size()));
    return std::span<const std::byte>(bytes_).first(sizeof(std::uint32_t) + writer.size());
}

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
        const auto valid = reader.read<std::uint8_t>();
        tool.valid = valid != 0;
        is_sound = is_sound && valid <= 1;
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
