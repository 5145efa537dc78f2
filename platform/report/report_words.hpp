// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <utility>

namespace tactus::hrtc
{

/// Word of the summary or the verdict, and its meaning.
using ReportWord = std::pair<const char*, const char*>;

/// Words of the page that a reader may not know: answers, times, causes of a fade.
[[nodiscard]] std::span<const ReportWord> report_words() noexcept;

} // namespace tactus::hrtc
