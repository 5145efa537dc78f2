// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::hrtc
{

/// From now on SIGINT and SIGTERM are noted: they end the run that is on, forces fading.
void install_signal_handlers();

/// Whether one of the signals has come.
[[nodiscard]] bool was_interrupted() noexcept;

} // namespace tactus::hrtc
