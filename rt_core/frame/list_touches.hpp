// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/object_touch.hpp"

#include <span>

namespace tactus
{

class Frame;
struct ObjectSpeedLimit;
struct PairOutput;

/// Lists the objects that tools may touch, as of the last frame, objects in reach first. An object
/// counts if it may be touched within ObjectSpeedLimit::kPatience_s, or by a displacement that is
/// not yet a jump (Tool::leap_m()). Tools without a force are skipped. `pairs` are the last frame's
/// output. Haptic thread, between frames.
void list_touches(const Frame& frame, std::span<const PairOutput> pairs,
                  const ObjectSpeedLimit& belief,
                  ObjectTouches& touches) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
