// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/udp/datagram.hpp"

#include "platform/remote/info_fault.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::udp
{

namespace
{

constexpr std::size_t kHeaderBytes = 32;
constexpr std::size_t kNameBytes = 32;
static_assert(kNameBytes == kDeviceNameMax + 1);

/// Beyond it no sample is usable anyway (docs/conventions.md).
constexpr double kCoordinateMax = 1e6;

/// Sums of two such times don't overflow.
constexpr std::int64_t kTimeMax_ns = std::int64_t{1} << 62;

constexpr std::uint32_t kValid = 1;
constexpr std::uint32_t kHasVelocity = 2;
constexpr std::uint32_t kDeadmanHeld = 4;

/// Fills a datagram from its start; close() puts the checksum at its end.
template <std::size_t Size>
class Writer
{
public:
    Writer(Kind kind, const Address& address) noexcept
    {
        put(kMagic);
        put(kVersion);
        put(kind);
        put(address.instance);
        put(address.session);
        put(address.sequence);
    }

    template <typename T>
    void put(const T& value) noexcept
    {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(bytes_.data() + at_, &value, sizeof(T));
        at_ += sizeof(T);
    }

    [[nodiscard]] std::array<std::byte, Size> close() noexcept
    {
        TACTUS_ASSERT(at_ == Size - 4);
        put(crc32c(std::span<const std::byte>(bytes_).first(Size - 4)));
        return bytes_;
    }

private:
    std::array<std::byte, Size> bytes_{};
    std::size_t at_{0};
};

bool are_in_range(const std::array<double, 3>& values, double most) noexcept
{
    return std::ranges::all_of(values, [most](double value) { return std::abs(value) <= most; });
}

std::size_t size_of(Kind kind) noexcept
{
    switch (kind)
    {
    case Kind::describe:
        return kDescribeBytes;
    case Kind::sample:
        return kSampleBytes;
    case Kind::force:
        return kForceBytes;
    }
    return 0;
}

struct Envelope
{
    Kind kind{Kind::describe};
    Address address;
};

/// What all datagrams have in common, checksum included; none when it is sound.
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
    if (reader.read<std::uint16_t>() != kVersion)
    {
        return DatagramFault::version;
    }
    envelope.kind = static_cast<Kind>(reader.read<std::uint16_t>());
    if (size_of(envelope.kind) == 0)
    {
        return DatagramFault::kind;
    }
    if (bytes.size() != size_of(envelope.kind))
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

/// False when something stands behind the zero that ends it, or nothing in front.
bool read_name(ByteReader& reader, std::string& name)
{
    const auto field = reader.read<std::array<char, kNameBytes>>();
    const auto end = std::ranges::find(field, '\0');
    name.assign(field.begin(), end);
    return std::all_of(end, field.end(), [](char c) { return c == '\0'; });
}

FromDevice decode_describe(const Address& address, ByteReader reader)
{
    DescribeDatagram datagram{address, {}};
    DeviceInfo& info = datagram.info;
    const bool is_name_clean = read_name(reader, info.name);
    DeviceLimits& limits = info.limits;
    for (double* value :
         {&limits.mass_kg, &limits.damping_n_s_per_m, &limits.friction_n, &limits.quantum_m,
          &limits.delay_s, &limits.force_max_n, &limits.slew_max_n_per_s,
          &limits.stiffness_max_n_per_m, &limits.added_damping_max_n_s_per_m})
    {
        *value = reader.read<double>();
    }
    info.workspace_centre_world_m = reader.read<std::array<double, 3>>();
    info.workspace_radius_m = reader.read<double>();
    info.speed_max_m_per_s = reader.read<double>();
    info.rate_min_hz = reader.read<std::int64_t>();
    info.rate_max_hz = reader.read<std::int64_t>();
    const bool is_reserved_clean = reader.read<std::uint32_t>() == 0;
    if (!is_name_clean || !is_reserved_clean || address.session != 0 || find_fault(info) != nullptr)
    {
        return DatagramFault::content;
    }
    return datagram;
}

FromDevice decode_sample(const Address& address, ByteReader reader) noexcept
{
    SampleDatagram datagram;
    datagram.address = address;
    datagram.position_m = reader.read<std::array<double, 3>>();
    const auto velocity = reader.read<std::array<double, 3>>();
    datagram.time_ns = reader.read<std::int64_t>();
    const auto flags = reader.read<std::uint32_t>();
    datagram.valid = (flags & kValid) != 0;
    datagram.deadman_held = (flags & kDeadmanHeld) != 0;
    if ((flags & ~(kValid | kHasVelocity | kDeadmanHeld)) != 0 || datagram.time_ns < 0 ||
        datagram.time_ns > kTimeMax_ns)
    {
        return DatagramFault::content;
    }
    if (!datagram.valid)
    {
        datagram.position_m = {};
        return datagram;
    }
    if ((flags & kHasVelocity) != 0)
    {
        datagram.velocity_m_per_s = velocity;
    }
    const bool is_velocity_good =
        !datagram.velocity_m_per_s || are_in_range(velocity, kCoordinateMax);
    if (!are_in_range(datagram.position_m, kCoordinateMax) || !is_velocity_good)
    {
        return DatagramFault::content;
    }
    return datagram;
}

} // namespace

DescribeBytes encode(const DescribeDatagram& datagram) noexcept
{
    Writer<kDescribeBytes> writer(Kind::describe, datagram.address);
    std::array<char, kNameBytes> name{};
    const DeviceInfo& info = datagram.info;
    std::ranges::copy(std::string_view(info.name).substr(0, kDeviceNameMax), name.begin());
    writer.put(name);
    const DeviceLimits& limits = info.limits;
    for (const double value :
         {limits.mass_kg, limits.damping_n_s_per_m, limits.friction_n, limits.quantum_m,
          limits.delay_s, limits.force_max_n, limits.slew_max_n_per_s, limits.stiffness_max_n_per_m,
          limits.added_damping_max_n_s_per_m})
    {
        writer.put(value);
    }
    writer.put(info.workspace_centre_world_m);
    writer.put(info.workspace_radius_m);
    writer.put(info.speed_max_m_per_s);
    writer.put(info.rate_min_hz);
    writer.put(info.rate_max_hz);
    writer.put(std::uint32_t{0});
    return writer.close();
}

SampleBytes encode(const SampleDatagram& datagram) noexcept
{
    Writer<kSampleBytes> writer(Kind::sample, datagram.address);
    writer.put(datagram.position_m);
    writer.put(datagram.velocity_m_per_s.value_or(std::array<double, 3>{}));
    writer.put(datagram.time_ns);
    writer.put((datagram.valid ? kValid : 0U) |
               (datagram.velocity_m_per_s.has_value() ? kHasVelocity : 0U) |
               (datagram.deadman_held ? kDeadmanHeld : 0U));
    return writer.close();
}

ForceBytes encode(const ForceDatagram& datagram) noexcept
{
    Writer<kForceBytes> writer(Kind::force, datagram.address);
    writer.put(datagram.force_n);
    writer.put(datagram.answers);
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
        "from somebody else while a device is attached",
        "of another session",
        "not newer than the last one",
        "another device than the first one"};
    return kTexts.at(static_cast<std::size_t>(fault));
}

FromDevice decode_from_device(std::span<const std::byte> bytes)
{
    Envelope envelope;
    if (const auto fault = open(bytes, envelope))
    {
        return *fault;
    }
    const ByteReader body(bytes.subspan(kHeaderBytes));
    switch (envelope.kind)
    {
    case Kind::describe:
        return decode_describe(envelope.address, body);
    case Kind::sample:
        return decode_sample(envelope.address, body);
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
    datagram.force_n = reader.read<std::array<double, 3>>();
    datagram.answers = reader.read<std::uint64_t>();
    const auto state = reader.read<std::uint32_t>();
    if (state > static_cast<std::uint32_t>(DeviceState::brake) ||
        !are_in_range(datagram.force_n, kCoordinateMax))
    {
        return DatagramFault::content;
    }
    datagram.state = static_cast<DeviceState>(state);
    return datagram;
}

} // namespace tactus::udp
