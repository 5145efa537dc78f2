// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_encoder.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace tactus
{

namespace
{

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
        std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
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

void write_rotation(FixedWriter& writer, const Mat3& rotation) noexcept
{
    for (int row = 0; row < 3; ++row)
    {
        writer.write_vector(rotation.row(row).transpose());
    }
}

void write_tool(FixedWriter& writer, const ToolState& tool) noexcept
{
    writer.write_vector(tool.position_m);
    writer.write(tool.sample_time_ns);
    writer.write(tool.elapsed_periods);
    const bool is_turned = tool.rotation != Mat3::Identity();
    writer.write(
        static_cast<std::uint8_t>((tool.valid ? kIsValid : 0U) | (is_turned ? kHasRotation : 0U)));
    if (is_turned)
    {
        write_rotation(writer, tool.rotation);
    }
}

void write_pose(FixedWriter& writer, const ObjectPose& pose) noexcept
{
    write_rotation(writer, pose.rotation);
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
    if (std::equal(now.begin(), now.end(), last.begin()))
    {
        return false;
    }
    std::copy(now.begin(), now.end(), last.begin());
    return true;
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

} // namespace tactus
