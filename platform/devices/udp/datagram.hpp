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

/// The datagrams of docs/udp-device.md: of a size for each kind and version, little-endian, each
/// closed by its CRC-32C. Any thread: values, and functions of their arguments alone; a
/// description's name allocates, nothing else does.
namespace tactus::udp
{

inline constexpr std::uint32_t kMagic = 0x44544354; ///< "TCTD".
inline constexpr std::uint16_t kVersion = 2;
/// Still understood: devices that don't turn, without buttons and gripper.
inline constexpr std::uint16_t kVersionOfPoints = 1;

/// Of describe, sample and force, in version 1 and 2.
inline constexpr std::array<std::array<std::size_t, 3>, 2> kBytes{{{200, 96, 72}, {288, 180, 120}}};
inline constexpr std::size_t kDatagramBytesMax = 288;
/// Room in version 2 for a proof of who sends: see Seal.
using Tag = std::array<std::byte, 16>;

enum class Kind : std::uint16_t
{
    describe = 1, ///< Device to controller: what it is.
    sample = 2,   ///< Device to controller: one reading.
    force = 3     ///< Controller to device.
};

/// Who speaks, and when.
struct Address
{
    std::uint64_t instance{0}; ///< Chosen by the device program when it starts; never 0.
    std::uint64_t session{0};  ///< Given by the controller; 0 in `describe`.
    std::uint64_t sequence{0}; ///< Counted by each sender from 1.
};

/// The centre of the workspace is in the device's coordinates here.
struct DescribeDatagram
{
    Address address;
    DeviceInfo info;
    std::uint16_t version{kVersion};
    Tag tag{};
};

struct SampleDatagram
{
    Address address;
    std::array<double, 3> position_m{};
    std::optional<std::array<double, 3>> velocity_m_per_s;
    std::int64_t time_ns{0}; ///< On the device's own clock, in [0, 2^62].
    bool valid{false};       ///< False: the position is not looked at, whatever it is.
    bool deadman_held{true};
    std::optional<std::array<double, 4>> rotation; ///< Unit quaternion x, y, z, w.
    std::optional<std::array<double, 3>> angular_velocity_rad_per_s;
    std::optional<double> gripper_m;
    std::uint32_t buttons{0};
    std::uint16_t version{kVersion};
    Tag tag{};
};

struct ForceDatagram
{
    Address address;
    std::array<double, 3> force_n{};
    DeviceState state{DeviceState::idle};
    std::uint64_t answers{0}; ///< Sequence of the device's last datagram that was accepted.
    std::array<double, 3> torque_nm{};
    double gripper_force_n{0.0};
    std::uint16_t version{kVersion};
    Tag tag{};
};

class Seal;

/// A coded datagram, as long as its kind and version say.
class Datagram
{
public:
    [[nodiscard]] const std::byte* data() const noexcept { return bytes_.data(); }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] const std::byte* begin() const noexcept { return data(); }
    [[nodiscard]] const std::byte* end() const noexcept { return data() + size_; }

private:
    friend class DatagramWriter;
    friend Datagram sealed(Datagram datagram, const Seal& seal) noexcept;

    std::array<std::byte, kDatagramBytesMax> bytes_{};
    std::size_t size_{0};
};

/// Proves who sent a datagram, by a key that both sides have (docs/udp-device.md).
class Seal
{
public:
    virtual ~Seal() = default;

    /// Of a datagram up to its checksum, with a tag of zeros. Any thread; allocates nothing and
    /// waits for nothing.
    [[nodiscard]] virtual Tag tag_of(std::span<const std::byte> bytes) const noexcept = 0;
};

/// With its tag, and the checksum of that. Only of version 2 (asserted).
[[nodiscard]] Datagram sealed(Datagram datagram, const Seal& seal) noexcept;
/// Whether a datagram that decodes has the right tag; false for one of version 1.
[[nodiscard]] bool is_sealed(std::span<const std::byte> bytes, const Seal& seal) noexcept;

/// A name longer than 31 bytes is cut. What its version doesn't know is left out.
[[nodiscard]] Datagram encode(const DescribeDatagram& datagram) noexcept;
[[nodiscard]] Datagram encode(const SampleDatagram& datagram) noexcept;
[[nodiscard]] Datagram encode(const ForceDatagram& datagram) noexcept;

/// Why a datagram counts for nothing. The first six are found by decode().
enum class DatagramFault : std::uint8_t
{
    size,         ///< Not that of its kind.
    magic,        ///< Somebody else's.
    version,      ///< Another version of this protocol.
    kind,         ///< None that is sent this way.
    checksum,     ///< Changed on its way.
    content,      ///< A value that is not finite or out of its range; a reserved bit that is set.
    foreign,      ///< From somebody else while a device is attached.
    session,      ///< A sample of another session.
    stale,        ///< Not newer than what was accepted before.
    other_device, ///< Describes another device than the first one: limits never change.
    tag,          ///< Not sealed by the key.
};
inline constexpr std::size_t kDatagramFaults = 11;
/// In the order of DatagramFault.
inline constexpr std::array<const char*, kDatagramFaults> kDatagramFaultNames{
    "size",    "magic",   "version", "kind",         "checksum", "content",
    "foreign", "session", "stale",   "other_device", "tag"};

/// "wrong size", ready to stand behind a colon.
[[nodiscard]] std::string_view text_of(DatagramFault fault) noexcept;

/// What a controller takes in.
using FromDevice = std::variant<DescribeDatagram, SampleDatagram, DatagramFault>;
/// What a device takes in.
using FromController = std::variant<ForceDatagram, DatagramFault>;

/// Of DatagramFault::content, `wrong`, if it isn't null, is set to the name of the value.
[[nodiscard]] FromDevice decode_from_device(std::span<const std::byte> bytes,
                                            const char** wrong = nullptr);
[[nodiscard]] FromController decode_from_controller(std::span<const std::byte> bytes);

} // namespace tactus::udp
