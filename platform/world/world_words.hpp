// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <string>

namespace tactus::hrtc
{

/// The text with the names of hrtc's options replaced by those of a World.
[[nodiscard]] std::string world_words(std::string text);

[[nodiscard]] inline Refusal in_world_words(const Refusal& refusal)
{
    return {world_words(refusal.text), refusal.is_usage};
}

} // namespace tactus::hrtc
