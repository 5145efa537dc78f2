// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/udp/datagram.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <string>

// An ordinary thread: it reads a file.
namespace tactus::hrtc
{

/// An authenticator with the key in this file: 64 hexadecimal digits, and white space round them.
/// Its tags are keyed BLAKE2b (RFC 7693) of 16 bytes. Refused: a file that can't be read or holds
/// anything else, and one that others than its owner and group may read.
[[nodiscard]] Result<std::shared_ptr<const udp::Authenticator>, Refusal>
read_device_key(const std::string& path);

} // namespace tactus::hrtc
