// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/flaw.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model.hpp"

namespace tactus
{

/// Checks the invariants of a model's pages, cache, forest and tree at the end of a frame. Returns
/// the first flaw, in the order of their dependencies. About 50 ns for each face, record and slot
/// in use.
[[nodiscard]] Flaw find_flaw(const Model& model) noexcept TACTUS_NONBLOCKING;

/// Asserts that a model has no flaw.
void require_sound(const Model& model) noexcept TACTUS_NONBLOCKING;

/// Calls require_sound() in builds with TACTUS_VALIDATE; otherwise does nothing.
inline void validate([[maybe_unused]] const Model& model) noexcept TACTUS_NONBLOCKING
{
#ifdef TACTUS_VALIDATE
    require_sound(model);
#endif
}

} // namespace tactus
