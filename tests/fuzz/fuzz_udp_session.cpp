// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a conversation with a udp device; bytes past the end are 0. Each datagram is
///
///     control   1 byte: bits 0 and 1 choose the time before it, bit 2 its sender, bit 3 writes the
///               present session's number into it, bit 4 ends a silence first, bit 5 settles first
///     size      2 bytes, little-endian
///     bytes     the datagram; its checksum is made right, or it would not be parsed
///
/// A second session has a key. It gets each datagram as it is, then with a tag.
#include "platform/devices/udp/session.hpp"
#include "rt_core/base/crc32c.hpp"
#include "tests/fuzz/input_parts.hpp"
#include "tests/fuzz/law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::fuzz
{

namespace
{

using Received = std::variant<udp::Described, udp::Sampled, udp::DatagramFault>;

constexpr std::array<udp::Endpoint, 2> kSenders{{{0x7F00'0001, 50'000}, {0x7F00'0001, 50'001}}};
constexpr std::size_t kSessionAt = 16;
constexpr std::size_t kChecksumSize = 4;

/// Tags that the other side can compute, which is all that this target needs.
class OpenKey final : public udp::Authenticator
{
public:
    [[nodiscard]] udp::Tag tag_of(std::span<const std::byte> bytes) const noexcept override
    {
        udp::Tag tag{};
        const std::uint32_t sum = crc32c(bytes);
        std::memcpy(tag.data(), &sum, sizeof(sum));
        return tag;
    }
};

void seal_datagram(std::vector<std::byte>& bytes)
{
    if (bytes.size() >= kChecksumSize)
    {
        const std::size_t end = bytes.size() - kChecksumSize;
        const std::uint32_t sum = crc32c(std::span(bytes).first(end));
        std::memcpy(bytes.data() + end, &sum, sizeof(sum));
    }
}

bool are_finite(const Vec3& vector)
{
    return std::isfinite(vector.x()) && std::isfinite(vector.y()) && std::isfinite(vector.z());
}

void check_reading(const DeviceReading& reading)
{
    if (!reading.valid)
    {
        return;
    }
    require(are_finite(reading.position_m) && reading.position_m.cwiseAbs().maxCoeff() <= 1e6,
            "an accepted position is within 1e6 m");
    require(!reading.velocity_m_per_s || are_finite(*reading.velocity_m_per_s),
            "an accepted velocity is finite");
    require(!reading.angular_velocity_rad_per_s || are_finite(*reading.angular_velocity_rad_per_s),
            "an accepted angular velocity is finite");
    require(!reading.gripper_m || std::isfinite(*reading.gripper_m),
            "an accepted gripper is finite");
}

/// A datagram that was decoded is encoded, decoded and encoded again, to the same bytes.
template <typename Kind, typename Decode>
void check_coding(const Kind& decoded, Decode&& decode)
{
    const udp::Datagram first = udp::encode(decoded);
    const auto again = decode(first);
    const Kind* same = std::get_if<Kind>(&again);
    require(same != nullptr, "an encoded datagram can be decoded");
    const udp::Datagram second = udp::encode(*same);
    require(std::equal(first.begin(), first.end(), second.begin(), second.end()),
            "a decoded datagram is encoded again to the same bytes");
}

/// Hands one datagram to a session, and checks what it changed.
Received pass(udp::Session& session, std::span<const std::byte> bytes, const udp::Endpoint& from,
              MonotonicTime now)
{
    const udp::Peer before = session.peer();
    const std::uint64_t answered = session.answers();
    Received received = session.receive(bytes, from, now);
    const udp::Peer& after = session.peer();
    if (std::holds_alternative<udp::DatagramFault>(received))
    {
        require(after.endpoint == before.endpoint && after.instance == before.instance &&
                    after.session == before.session && after.is_attached == before.is_attached &&
                    session.answers() == answered,
                "a refused datagram changes no session");
        return received;
    }
    require(after.is_attached && after.endpoint == from && session.info().has_value(),
            "an accepted datagram is of the attached device, which is described");
    if (const auto* sampled = std::get_if<udp::Sampled>(&received))
    {
        require(session.answers() > answered, "an accepted sample is newer than the last one");
        check_reading(sampled->reading);
        ++accepted_inputs;
    }
    return received;
}

/// What the controller and both of its sessions make of one datagram.
class Conversation
{
public:
    void receive(std::vector<std::byte> bytes, unsigned control)
    {
        constexpr std::array<std::int64_t, 4> kPauses_ms{0, 1, 60, 1'000};
        now_ = now_ + milliseconds(kPauses_ms.at(control & 3U));
        const udp::Endpoint& from = kSenders.at((control >> 2U) & 1U);
        if ((control & 8U) != 0 && bytes.size() >= kSessionAt + sizeof(std::uint64_t))
        {
            const std::uint64_t number = open_.peer().session;
            std::memcpy(bytes.data() + kSessionAt, &number, sizeof(number));
        }
        if ((control & 16U) != 0)
        {
            static_cast<void>(open_.lapse(now_));
            static_cast<void>(guarded_.lapse(now_));
        }
        if ((control & 32U) != 0 && open_.info())
        {
            open_.settle();
        }
        seal_datagram(bytes);
        static_cast<void>(pass(open_, bytes, from, now_));
        const auto guarded = pass(guarded_, bytes, from, now_);
        require(std::holds_alternative<udp::DatagramFault>(guarded) ||
                    udp::is_authentic(bytes, key_),
                "without its tag no datagram is accepted");
        decode(bytes, from);
    }

private:
    void decode(std::span<const std::byte> bytes, const udp::Endpoint& from)
    {
        const auto of_device = [](const udp::Datagram& datagram) {
            return udp::decode_from_device({datagram.data(), datagram.size()});
        };
        const char* wrong = nullptr;
        const auto from_device = udp::decode_from_device(bytes, &wrong);
        if (const auto* fault = std::get_if<udp::DatagramFault>(&from_device))
        {
            require(*fault != udp::DatagramFault::content ||
                        (wrong != nullptr && is_one_clear_line(wrong)),
                    "a wrong value is named in one clear line");
        }
        const auto with_tag = [&](const auto& datagram)
        {
            check_coding(datagram, of_device);
            if (datagram.version == udp::kVersion)
            {
                const udp::Datagram tagged = udp::authenticated(udp::encode(datagram), key_);
                const std::span signed_bytes(tagged.data(), tagged.size());
                require(udp::is_authentic(signed_bytes, key_), "a datagram's own tag is right");
                static_cast<void>(pass(guarded_, signed_bytes, from, now_));
            }
        };
        if (const auto* description = std::get_if<udp::DescribeDatagram>(&from_device))
        {
            with_tag(*description);
        }
        if (const auto* sample = std::get_if<udp::SampleDatagram>(&from_device))
        {
            with_tag(*sample);
        }
        const auto from_controller = udp::decode_from_controller(bytes);
        if (const auto* force = std::get_if<udp::ForceDatagram>(&from_controller))
        {
            check_coding(*force,
                         [](const udp::Datagram& datagram) {
                             return udp::decode_from_controller({datagram.data(), datagram.size()});
                         });
        }
    }

    OpenKey key_;
    MonotonicTime now_{5'000'000'000};
    udp::Session open_{7, milliseconds(20), milliseconds(200)};
    udp::Session guarded_{7, milliseconds(20), milliseconds(200), &key_};
};

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    fuzz::InputParts input(data, size);
    fuzz::Conversation conversation;
    while (!input.is_at_end())
    {
        fuzz::InputParts::Part part = input.part();
        conversation.receive(std::move(part.bytes), part.control);
    }
    return 0;
}
