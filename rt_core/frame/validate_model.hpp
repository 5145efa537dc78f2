// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model.hpp"

namespace tactus
{

/// Holds pages, cache, forest and tree of a model against what they promise at the end of a frame,
/// those first on which the others rely. Some 50 ns for each face, record and slot in use.
[[nodiscard]] Flaw find_flaw(const Model& model) noexcept TACTUS_NONBLOCKING;

/// As a failed assertion, when there is a flaw: what TACTUS_VALIDATE adds to every frame.
void require_sound(const Model& model) noexcept TACTUS_NONBLOCKING;

/// require_sound() in builds with TACTUS_VALIDATE; nothing in others.
inline void validate([[maybe_unused]] const Model& model) noexcept TACTUS_NONBLOCKING
{
#ifdef TACTUS_VALIDATE
    require_sound(model);
#endif
}

} // namespace tactus
