// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tactus::dds
{

/// Restricts sockets to loopback: Cyclone 0.10 binds its receiving sockets to all interfaces, even
/// when configured for one. Calls `open_sockets`, then binds each UDP socket that it opened for
/// every interface to the loopback device, so nothing from outside arrives there. Returns the
/// reason if that fails. No other thread may open such a socket meanwhile. Linux only; on other
/// systems the sockets stay as they are.
[[nodiscard]] std::optional<std::string>
opened_on_loopback(const std::function<void()>& open_sockets);

} // namespace tactus::dds
