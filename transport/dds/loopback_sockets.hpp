// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tactus::dds
{

/// Restricts sockets to loopback: Cyclone 0.10 binds its receiving sockets to all interfaces,
/// regardless of its configuration. Calls `open_sockets`, then binds each UDP socket that it opened
/// for all interfaces to the loopback device. Returns the reason if that fails. No other thread may
/// open such sockets meanwhile. Has no effect on systems other than Linux.
[[nodiscard]] std::optional<std::string>
opened_on_loopback(const std::function<void()>& open_sockets);

} // namespace tactus::dds
