// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

namespace tactus
{

class NarrowPhase;
struct FrameAccount;
struct FrameParts;

/// Last stage of a frame: moves each present tool that does not rest towards its device and
/// computes its force, into ToolSet::outputs(). If the queries prove too little for the whole way,
/// the tool moves in several steps, with new queries before each. Haptic thread. Cost: linear in
/// the planes near each tool and in its steps, at most 24 for a sphere and 4 for a rigid tool. For
/// a sphere 1 to 38 us from median to 99th percentile (docs/benchmarks.md).
void render_forces(FrameParts& parts, NarrowPhase& narrow,
                   FrameAccount& account) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
