// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

/// Datagrams of docs/udp-device.md: of a fixed size for each kind and version, little-endian, with
/// a CRC-32C at the end. Any thread: values, and functions of their arguments alone. Only the name
/// in a description allocates.
namespace tactus::udp
{

inline constexpr std::uint32_t kMagic = 0x44544354; ///< "TCTD".
inline constexpr std::uint16_t kVersion = 2;
/// Older version, still accepted: no rotation, buttons or gripper.
inline constexpr std::uint16_t kVersionOfPoints = 1;

/// Sizes in bytes by version (1, 2) and kind (describe, sample, force).
inline constexpr std::array<std::array<std::size_t, 3>, 2> kBytes{{{200, 96, 72}, {288, 180, 120}}};
inline constexpr std::size_t kDatagramBytesMax = 288;
/// Authentication tag of a datagram in version 2: see Authenticator.
using Tag = std::array<std::byte, 16>;

enum class Kind : std::uint16_t
{
    describe = 1, ///< Device to controller: its description.
    sample = 2,   ///< Device to controller: one reading.
    force = 3     ///< Controller to device: wrench and state.
};

/// Sender and sequence of a datagram.
struct Address
{
    std::uint64_t instance{0}; ///< Number chosen by the device program when it starts; never 0.
    std::uint64_t session{0};  ///< Number assigned by the controller; 0 in `describe`.
    std::uint64_t sequence{0}; ///< Count of the sender's datagrams, from 1.
};

/// Description of a device. Its workspace centre is in the device's coordinates here.
struct DescribeDatagram
{
    Address address;
    DeviceInfo info;
    std::uint16_t version{kVersion};
    Tag tag{};
};

/// Reading of a device.
struct SampleDatagram
{
    Address address;
    std::array<double, 3> position_m{};
    std::optional<std::array<double, 3>> velocity_m_per_s;
    std::int64_t time_ns{0}; ///< Time on the device's own clock, in [0, 2^62].
    bool valid{false};       ///< False: pose, velocities and gripper are ignored.
    bool deadman_held{true};
    std::optional<std::array<double, 4>> rotation; ///< Unit quaternion x, y, z, w.
    std::optional<std::array<double, 3>> angular_velocity_rad_per_s;
    std::optional<double> gripper_m;
    std::uint32_t buttons{0};
    std::uint16_t version{kVersion};
    Tag tag{};
};

/// Force and torque for a device.
struct ForceDatagram
{
    Address address;
    std::array<double, 3> force_n{};
    DeviceState state{DeviceState::idle};
    /// Sequence of the last datagram accepted from the device; 0: not known.
    std::uint64_t answers{0};
    std::array<double, 3> torque_nm{};
    double gripper_force_n{0.0};
    std::uint16_t version{kVersion};
    Tag tag{};
};

class Authenticator;

/// An encoded datagram. Its kind and version determine its size.
class Datagram
{
public:
    [[nodiscard]] const std::byte* data() const noexcept { return bytes_.data(); }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] const std::byte* begin() const noexcept { return data(); }
    [[nodiscard]] const std::byte* end() const noexcept { return data() + size_; }

private:
    friend class DatagramWriter;
    friend Datagram authenticated(Datagram datagram, const Authenticator& authenticator) noexcept;

    std::array<std::byte, kDatagramBytesMax> bytes_{};
    std::size_t size_{0};
};

/// Computes authentication tags with a key that both sides share (docs/udp-device.md).
class Authenticator
{
public:
    virtual ~Authenticator() = default;

    /// Returns the tag of a datagram. `bytes` end before the checksum and have zeros in place of
    /// the tag. Any thread; neither allocates nor waits.
    [[nodiscard]] virtual Tag tag_of(std::span<const std::byte> bytes) const noexcept = 0;
};

/// Returns the datagram with its tag set and its checksum updated. Version 2 only (asserted).
[[nodiscard]] Datagram authenticated(Datagram datagram,
                                     const Authenticator& authenticator) noexcept;
/// True if the tag of a decodable datagram is right; false for version 1, which has no tags.
[[nodiscard]] bool is_authentic(std::span<const std::byte> bytes,
                                const Authenticator& authenticator) noexcept;

/// Encodes a datagram. Cuts a name after 31 bytes, and omits fields that the datagram's version
/// lacks.
[[nodiscard]] Datagram encode(const DescribeDatagram& datagram) noexcept;
[[nodiscard]] Datagram encode(const SampleDatagram& datagram) noexcept;
[[nodiscard]] Datagram encode(const ForceDatagram& datagram) noexcept;

/// Reasons to refuse a datagram. The first six are found by the decode functions.
enum class DatagramFault : std::uint8_t
{
    size,         ///< Size does not fit the kind.
    magic,        ///< Datagram of another protocol.
    version,      ///< Other version of this protocol.
    kind,         ///< Kind unknown, or not sent in this direction.
    checksum,     ///< Bytes changed in transit.
    content,      ///< Value not finite or out of its range, or reserved bit set.
    foreign,      ///< Sender other than the attached device.
    session,      ///< Sample of another session.
    stale,        ///< Sequence or time not above the last accepted one.
    other_device, ///< Description that differs from the first one.
    tag,          ///< Tag missing, or made with another key.
};
inline constexpr std::size_t kDatagramFaults = 11;
/// Names in the order of DatagramFault.
inline constexpr std::array<const char*, kDatagramFaults> kDatagramFaultNames{
    "size",    "magic",   "version", "kind",         "checksum", "content",
    "foreign", "session", "stale",   "other_device", "tag"};

/// Text of a fault, for instance "wrong size", for use after a colon.
[[nodiscard]] std::string_view text_of(DatagramFault fault) noexcept;

/// Datagrams that a controller receives.
using FromDevice = std::variant<DescribeDatagram, SampleDatagram, DatagramFault>;
/// Datagrams that a device receives.
using FromController = std::variant<ForceDatagram, DatagramFault>;

/// Decodes a datagram. `wrong` may be null; if the result is DatagramFault::content, `*wrong`
/// becomes the name of the value at fault.
[[nodiscard]] FromDevice decode_from_device(std::span<const std::byte> bytes,
                                            const char** wrong = nullptr);
[[nodiscard]] FromController decode_from_controller(std::span<const std::byte> bytes);

} // namespace tactus::udp
