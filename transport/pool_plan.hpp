// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/frame_setup.hpp"

#include <cstddef>
#include <span>

namespace tactus
{

/// The capacities of the models, one each, so that a frame, all pools and the courier that fills
/// them fit into `bytes` of an arena: `cache_bytes` of these for pages (0: the usual share).
/// `setup.models` is not looked at. False when they don't; `capacities` don't count then.
[[nodiscard]] bool try_plan_pools(const FrameSetup& setup, std::span<const ModelHeader> headers,
                                  std::size_t bytes, std::size_t cache_bytes,
                                  std::span<ModelCapacities> capacities);

/// The same where none of `setup.models`, which have headers alone, is here at the start, and all
/// come and go: the room for guests. As many base meshes at once as fit beside the pages, which get
/// three fifths of what is left; the largest one at least.
[[nodiscard]] bool try_plan_guests(const FrameSetup& setup, std::span<const ModelHeader> headers,
                                   std::size_t bytes, std::size_t cache_bytes,
                                   ModelCapacities& room);

/// The least bytes for which try_plan_pools() has a plan, rounded up to 64 KiB; 0 when even a
/// tebibyte has none.
[[nodiscard]] std::size_t least_pool_bytes(const FrameSetup& setup,
                                           std::span<const ModelHeader> headers,
                                           std::size_t cache_bytes);

} // namespace tactus
