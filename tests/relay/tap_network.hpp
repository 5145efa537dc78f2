// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tactus::relay
{

struct TapOptions
{
    std::string interface; ///< Its name, at most 15 characters.
    std::string address;   ///< IPv4; its network has 24 bits.
    int mtu_bytes{1'500};
};

struct TapError
{
    std::string text;
};

/// A network namespace of its own with one interface besides `lo`, the end of which is here. It has
/// no name and lives as long as this object, or a process in it: others enter it by
/// `nsenter --net=/proc/PID/fd/N` with this process and namespace_descriptor(). IPv6 is off in it,
/// so that nothing is sent in it that no program sends.
class TapNetwork
{
public:
    /// Makes namespace and interface, both up; the calling thread is back in its own namespace
    /// then. Needs CAP_SYS_ADMIN, CAP_NET_ADMIN and /dev/net/tun; says what was refused.
    [[nodiscard]] static Result<TapNetwork, TapError> create(const TapOptions& options);

    TapNetwork(TapNetwork&& other) noexcept;
    TapNetwork& operator=(TapNetwork&&) = delete;
    ~TapNetwork();

    [[nodiscard]] int namespace_descriptor() const { return namespace_; }
    /// To wait for frames that the network sends.
    [[nodiscard]] int tap_descriptor() const { return tap_; }

    /// The next frame that the network sent, whole; its size, 0 when there is none.
    [[nodiscard]] std::size_t read(std::span<std::byte> buffer) const;

    /// Frames that the network sent and the system dropped, since nobody read them in time.
    [[nodiscard]] std::uint64_t frames_missed() const;

    /// Gives the network a frame. False when the system refused it.
    [[nodiscard]] bool write(std::span<const std::byte> frame) const;

private:
    TapNetwork(const std::string& interface, int network, int tap, int statistics)
        : interface_(interface), namespace_(network), tap_(tap), statistics_(statistics)
    {
    }

    std::string interface_;
    int namespace_;
    int tap_;
    int statistics_; ///< Of the interfaces of the namespace in which it was opened.
};

} // namespace tactus::relay
