// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/udp/datagram.hpp"

#include "platform/devices/remote/remote_values.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace tactus::udp
{

/// Fills a datagram from its start; close() appends the checksum.
class DatagramWriter
{
public:
    DatagramWriter(Kind kind, const Address& address, std::uint16_t version) noexcept
    {
        TACTUS_ASSERT(is_known(version));
        datagram_.size_ = kBytes.at(version - 1U).at(static_cast<std::size_t>(kind) - 1U);
        put(kMagic);
        put(version);
        put(kind);
        put(address.instance);
        put(address.session);
        put(address.sequence);
    }

    template <typename T>
    void put(const T& value) noexcept
    {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(datagram_.bytes_.data() + at_, &value, sizeof(T));
        at_ += sizeof(T);
    }

    [[nodiscard]] const Datagram& close() noexcept
    {
        TACTUS_ASSERT(at_ == datagram_.size_ - 4);
        put(crc32c(std::span<const std::byte>(datagram_.bytes_).first(datagram_.size_ - 4)));
        return datagram_;
    }

    [[nodiscard]] static bool is_known(std::uint16_t version) noexcept
    {
        return version == kVersionOfPoints || version == kVersion;
    }

private:
    Datagram datagram_;
    std::size_t at_{0};
};

namespace
{

constexpr std::size_t kHeaderBytes = 32;
constexpr std::size_t kNameBytes = 32;
static_assert(kNameBytes == kDeviceNameMax + 1);

/// Offsets of the tag in describe, sample and force of version 2.
constexpr std::array<std::size_t, 3> kTagAt{264, 152, 96};
constexpr std::size_t kKindAt = 6;

/// Bound of each coordinate; samples beyond it are not usable anyway (docs/conventions.md).
constexpr double kCoordinateMax = 1e6;

/// Largest device time; sums of two such times don't overflow.
constexpr std::int64_t kTimeMax_ns = std::int64_t{1} << 62;

// Flag of a description.
constexpr std::uint32_t kMeasuresRotation = 1;
// Flags of a sample; the last three are of version 2.
constexpr std::uint32_t kValid = 1;
constexpr std::uint32_t kHasVelocity = 2;
constexpr std::uint32_t kDeadmanHeld = 4;
constexpr std::uint32_t kHasRotation = 8;
constexpr std::uint32_t kHasAngularVelocity = 16;
constexpr std::uint32_t kHasGripper = 32;

/// Limits in the order of a description.
constexpr std::array kLimits{&DeviceLimits::mass_kg,
                             &DeviceLimits::damping_n_s_per_m,
                             &DeviceLimits::friction_n,
                             &DeviceLimits::quantum_m,
                             &DeviceLimits::delay_s,
                             &DeviceLimits::force_max_n,
                             &DeviceLimits::slew_max_n_per_s,
                             &DeviceLimits::stiffness_max_n_per_m,
                             &DeviceLimits::added_damping_max_n_s_per_m};
constexpr std::array kRotationLimits{&RotationLimits::torque_max_nm,
                                     &RotationLimits::inertia_kg_m2,
                                     &RotationLimits::damping_nm_s_per_rad,
                                     &RotationLimits::friction_nm,
                                     &RotationLimits::quantum_rad,
                                     &RotationLimits::slew_max_nm_per_s,
                                     &RotationLimits::stiffness_max_nm_per_rad,
                                     &RotationLimits::added_damping_max_nm_s_per_rad};

bool are_in_range(const std::array<double, 3>& values, double most) noexcept
{
    return std::ranges::all_of(values, [most](double value) { return std::abs(value) <= most; });
}

struct Envelope
{
    Kind kind{Kind::describe};
    Address address;
    std::uint16_t version{0};
};

/// Checks header, size and checksum, which all kinds have, and fills `envelope`. Returns the fault;
/// none if all are sound.
std::optional<DatagramFault> open(std::span<const std::byte> bytes, Envelope& envelope) noexcept
{
    ByteReader reader(bytes);
    if (bytes.size() < kHeaderBytes || bytes.size() > kDatagramBytesMax)
    {
        return DatagramFault::size;
    }
    if (reader.read<std::uint32_t>() != kMagic)
    {
        return DatagramFault::magic;
    }
    envelope.version = reader.read<std::uint16_t>();
    if (!DatagramWriter::is_known(envelope.version))
    {
        return DatagramFault::version;
    }
    envelope.kind = static_cast<Kind>(reader.read<std::uint16_t>());
    if (envelope.kind < Kind::describe || envelope.kind > Kind::force)
    {
        return DatagramFault::kind;
    }
    const auto kind = static_cast<std::size_t>(envelope.kind);
    if (bytes.size() != kBytes.at(envelope.version - 1U).at(kind - 1U))
    {
        return DatagramFault::size;
    }
    envelope.address = reader.read<Address>();
    const std::size_t end = bytes.size() - 4;
    if (ByteReader(bytes.subspan(end)).read<std::uint32_t>() != crc32c(bytes.first(end)))
    {
        return DatagramFault::checksum;
    }
    const bool is_addressed = envelope.address.instance != 0 && envelope.address.sequence != 0;
    return is_addressed ? std::nullopt : std::optional(DatagramFault::content);
}

/// Reads a name that a zero ends. False if other bytes follow that zero.
bool read_name(ByteReader& reader, std::string& name)
{
    const auto field = reader.read<std::array<char, kNameBytes>>();
    const auto end = std::ranges::find(field, '\0');
    name.assign(field.begin(), end);
    return std::all_of(end, field.end(), [](char c) { return c == '\0'; });
}

FromDevice decode_describe(const Envelope& envelope, ByteReader reader, const char*& wrong)
{
    DescribeDatagram datagram{envelope.address, {}, envelope.version};
    DeviceInfo& info = datagram.info;
    const bool has_name = read_name(reader, info.name);
    for (double DeviceLimits::*const limit : kLimits)
    {
        info.limits.*limit = reader.read<double>();
    }
    info.workspace_centre_world_m = reader.read<std::array<double, 3>>();
    info.workspace_radius_m = reader.read<double>();
    info.speed_max_m_per_s = reader.read<double>();
    info.rate_min_hz = reader.read<std::int64_t>();
    info.rate_max_hz = reader.read<std::int64_t>();
    std::uint32_t known = 0;
    if (envelope.version >= kVersion)
    {
        for (double RotationLimits::*const limit : kRotationLimits)
        {
            info.limits.rotation.*limit = reader.read<double>();
        }
        info.gripper_force_max_n = reader.read<double>();
        datagram.tag = reader.read<Tag>();
        known = kMeasuresRotation;
    }
    const auto flags = reader.read<std::uint32_t>();
    info.limits.rotation.is_measured = (flags & kMeasuresRotation) != 0;
    wrong = !has_name                       ? "name"
            : (flags & ~known) != 0         ? "flags"
            : envelope.address.session != 0 ? "session"
                                            : find_fault(info);
    return wrong == nullptr ? FromDevice(std::move(datagram)) : FromDevice(DatagramFault::content);
}

/// Name of a value that is not finite or out of range; null if all are sound.
const char* wrong_value_in(const SampleDatagram& datagram) noexcept
{
    const auto is_good = [](const std::optional<std::array<double, 3>>& vector)
    { return !vector || are_in_range(*vector, kCoordinateMax); };
    const bool is_turned = datagram.rotation.has_value();
    return !are_in_range(datagram.position_m, kCoordinateMax) ? "position"
           : !is_good(datagram.velocity_m_per_s)              ? "velocity"
           : !is_good(datagram.angular_velocity_rad_per_s)    ? "angular velocity"
           : is_turned && !is_unit(*datagram.rotation, kRotationTolerance)
               ? "rotation, whose length is not within 1e-6 of 1"
           : datagram.gripper_m && !(std::abs(*datagram.gripper_m) <= kCoordinateMax) ? "gripper"
                                                                                      : nullptr;
}

FromDevice decode_sample(const Envelope& envelope, ByteReader reader, const char*& wrong) noexcept
{
    SampleDatagram datagram;
    datagram.address = envelope.address;
    datagram.version = envelope.version;
    const auto position_m = reader.read<std::array<double, 3>>();
    const auto velocity = reader.read<std::array<double, 3>>();
    datagram.time_ns = reader.read<std::int64_t>();
    Quaternion rotation{};
    std::array<double, 3> angular_velocity{};
    double gripper_m = 0.0;
    std::uint32_t known = kValid | kHasVelocity | kDeadmanHeld;
    if (envelope.version >= kVersion)
    {
        rotation = reader.read<Quaternion>();
        angular_velocity = reader.read<std::array<double, 3>>();
        gripper_m = reader.read<double>();
        datagram.tag = reader.read<Tag>();
        datagram.buttons = reader.read<std::uint32_t>();
        known |= kHasRotation | kHasAngularVelocity | kHasGripper;
    }
    const auto flags = reader.read<std::uint32_t>();
    datagram.valid = (flags & kValid) != 0;
    datagram.deadman_held = (flags & kDeadmanHeld) != 0;
    const bool has_time = datagram.time_ns >= 0 && datagram.time_ns <= kTimeMax_ns;
    wrong = (flags & ~known) != 0 ? "flags" : has_time ? nullptr : "time";
    if (wrong != nullptr)
    {
        return DatagramFault::content;
    }
    if (!datagram.valid)
    {
        return datagram;
    }
    const auto given = [flags](std::uint32_t flag, const auto& value)
    { return (flags & flag) != 0 ? std::optional(value) : std::nullopt; };
    datagram.position_m = position_m;
    datagram.velocity_m_per_s = given(kHasVelocity, velocity);
    datagram.rotation = given(kHasRotation, rotation);
    datagram.angular_velocity_rad_per_s = given(kHasAngularVelocity, angular_velocity);
    datagram.gripper_m = given(kHasGripper, gripper_m);
    wrong = wrong_value_in(datagram);
    return wrong == nullptr ? FromDevice(datagram) : FromDevice(DatagramFault::content);
}

std::uint32_t flag_when(bool is_so, std::uint32_t flag) noexcept
{
    return is_so ? flag : 0U;
}

/// Offset of the tag in a whole datagram of version 2.
std::size_t tag_at(std::span<const std::byte> bytes) noexcept
{
    const auto kind = ByteReader(bytes.subspan(kKindAt)).read<std::uint16_t>();
    return kTagAt.at(kind - 1U);
}

} // namespace

Datagram authenticated(Datagram datagram, const Authenticator& authenticator) noexcept
{
    const std::size_t end = datagram.size() - 4;
    TACTUS_ASSERT(end + 4 == kBytes[1][0] || end + 4 == kBytes[1][1] || end + 4 == kBytes[1][2]);
    const std::span<std::byte> covered = std::span(datagram.bytes_).first(end);
    const std::span<std::byte> place = covered.subspan(tag_at(covered), std::tuple_size_v<Tag>);
    std::ranges::fill(place, std::byte{0});
    std::ranges::copy(authenticator.tag_of(covered), place.begin());
    const std::uint32_t checksum = crc32c(covered);
    std::memcpy(datagram.bytes_.data() + end, &checksum, sizeof(checksum));
    return datagram;
}

bool is_authentic(std::span<const std::byte> bytes, const Authenticator& authenticator) noexcept
{
    if (std::ranges::find(kBytes[1], bytes.size()) == kBytes[1].end())
    {
        return false;
    }
    std::array<std::byte, kDatagramBytesMax> copy{};
    std::ranges::copy(bytes, copy.begin());
    const std::size_t at = tag_at(bytes);
    std::fill_n(copy.begin() + static_cast<std::ptrdiff_t>(at), std::tuple_size_v<Tag>,
                std::byte{0});
    const Tag right = authenticator.tag_of(std::span(copy).first(bytes.size() - 4));
    std::byte differs{0}; // The comparison takes constant time.
    for (std::size_t i = 0; i < right.size(); ++i)
    {
        differs |= right[i] ^ bytes[at + i];
    }
    return differs == std::byte{0};
}

Datagram encode(const DescribeDatagram& datagram) noexcept
{
    DatagramWriter writer(Kind::describe, datagram.address, datagram.version);
    std::array<char, kNameBytes> name{};
    const DeviceInfo& info = datagram.info;
    std::ranges::copy(std::string_view(info.name).substr(0, kDeviceNameMax), name.begin());
    writer.put(name);
    for (double DeviceLimits::*const limit : kLimits)
    {
        writer.put(info.limits.*limit);
    }
    writer.put(info.workspace_centre_world_m);
    writer.put(info.workspace_radius_m);
    writer.put(info.speed_max_m_per_s);
    writer.put(info.rate_min_hz);
    writer.put(info.rate_max_hz);
    if (datagram.version < kVersion)
    {
        writer.put(std::uint32_t{0});
        return writer.close();
    }
    for (double RotationLimits::*const limit : kRotationLimits)
    {
        writer.put(info.limits.rotation.*limit);
    }
    writer.put(info.gripper_force_max_n);
    writer.put(datagram.tag);
    writer.put(flag_when(info.limits.rotation.is_measured, kMeasuresRotation));
    return writer.close();
}

Datagram encode(const SampleDatagram& datagram) noexcept
{
    DatagramWriter writer(Kind::sample, datagram.address, datagram.version);
    writer.put(datagram.position_m);
    writer.put(datagram.velocity_m_per_s.value_or(std::array<double, 3>{}));
    writer.put(datagram.time_ns);
    std::uint32_t flags = flag_when(datagram.valid, kValid) |
                          flag_when(datagram.velocity_m_per_s.has_value(), kHasVelocity) |
                          flag_when(datagram.deadman_held, kDeadmanHeld);
    if (datagram.version >= kVersion)
    {
        writer.put(datagram.rotation.value_or(Quaternion{}));
        writer.put(datagram.angular_velocity_rad_per_s.value_or(std::array<double, 3>{}));
        writer.put(datagram.gripper_m.value_or(0.0));
        writer.put(datagram.tag);
        writer.put(datagram.buttons);
        flags |= flag_when(datagram.rotation.has_value(), kHasRotation) |
                 flag_when(datagram.angular_velocity_rad_per_s.has_value(), kHasAngularVelocity) |
                 flag_when(datagram.gripper_m.has_value(), kHasGripper);
    }
    writer.put(flags);
    return writer.close();
}

Datagram encode(const ForceDatagram& datagram) noexcept
{
    DatagramWriter writer(Kind::force, datagram.address, datagram.version);
    writer.put(datagram.force_n);
    if (datagram.version >= kVersion)
    {
        writer.put(datagram.torque_nm);
        writer.put(datagram.gripper_force_n);
    }
    writer.put(datagram.answers);
    if (datagram.version >= kVersion)
    {
        writer.put(datagram.tag);
    }
    writer.put(static_cast<std::uint32_t>(datagram.state));
    return writer.close();
}

std::string_view text_of(DatagramFault fault) noexcept
{
    constexpr std::array<std::string_view, kDatagramFaults> kTexts{
        "wrong size",
        "wrong magic",
        "wrong version",
        "wrong kind",
        "wrong checksum",
        "a value that is not finite or out of range",
        "from another sender while a device is attached",
        "wrong session",
        "not newer than the last datagram",
        "a device other than the first one",
        "not authenticated by the key"};
    return kTexts.at(static_cast<std::size_t>(fault));
}

FromDevice decode_from_device(std::span<const std::byte> bytes, const char** wrong)
{
    const char* ignored = nullptr;
    const char*& value = wrong != nullptr ? *wrong : ignored;
    Envelope envelope;
    if (const auto fault = open(bytes, envelope))
    {
        value = "address"; // This is the one content that open() checks.
        return *fault;
    }
    const ByteReader body(bytes.subspan(kHeaderBytes));
    switch (envelope.kind)
    {
    case Kind::describe:
        return decode_describe(envelope, body, value);
    case Kind::sample:
        return decode_sample(envelope, body, value);
    case Kind::force:
        break;
    }
    return DatagramFault::kind;
}

FromController decode_from_controller(std::span<const std::byte> bytes)
{
    Envelope envelope;
    if (const auto fault = open(bytes, envelope))
    {
        return *fault;
    }
    if (envelope.kind != Kind::force)
    {
        return DatagramFault::kind;
    }
    ByteReader reader(bytes.subspan(kHeaderBytes));
    ForceDatagram datagram;
    datagram.address = envelope.address;
    datagram.version = envelope.version;
    datagram.force_n = reader.read<std::array<double, 3>>();
    if (envelope.version >= kVersion)
    {
        datagram.torque_nm = reader.read<std::array<double, 3>>();
        datagram.gripper_force_n = reader.read<double>();
    }
    datagram.answers = reader.read<std::uint64_t>();
    if (envelope.version >= kVersion)
    {
        datagram.tag = reader.read<Tag>();
    }
    const auto state = reader.read<std::uint32_t>();
    if (state > static_cast<std::uint32_t>(DeviceState::brake) ||
        !are_in_range(datagram.force_n, kCoordinateMax) ||
        !are_in_range(datagram.torque_nm, kCoordinateMax) ||
        !(std::abs(datagram.gripper_force_n) <= kCoordinateMax))
    {
        return DatagramFault::content;
    }
    datagram.state = static_cast<DeviceState>(state);
    return datagram;
}

} // namespace tactus::udp
