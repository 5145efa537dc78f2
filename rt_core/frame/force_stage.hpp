// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/frame/narrow_phase.hpp"

namespace tactus
{

/// A frame's last stage: each tool that is here and does not rest goes towards its hand and answers
/// with a force, into ToolSet::outputs(). A tool that has farther to go than its queries prove goes
/// in up to RigidProxy::kStepsPerFrame steps, with its queries asked again before each. Haptic
/// thread.
void render_forces(FrameParts& parts, NarrowPhase& narrow,
                   FrameAccount& account) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
