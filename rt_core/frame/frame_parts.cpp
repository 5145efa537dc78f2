// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame_parts.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Copies the header, reads the base mesh and lays out one model. False when the base mesh is
/// damaged. The header must parse.
[[nodiscard]] bool try_take_model(std::optional<Model>& model, Arena& arena, ModelPools& pools,
                                  ModelId id, const FrameSetup& setup) noexcept
{
    const ModelSource& source = setup.models[id.value];
    const std::span<std::byte> header_bytes = arena.take<std::byte>(source.header.size());
    std::span<const std::byte> kept = source.header;
    if (!arena.is_measuring())
    {
        std::ranges::copy(source.header, header_bytes.begin());
        kept = header_bytes;
    }
    const ModelHeader header = ModelHeader::parse(kept).value();
    const bool comes_later = is_guest(setup, id.value);
    const PageSlots slots =
        comes_later ? pools.slots.without_base() : pools.slots.of_model(arena, header.counts());
    if (!comes_later && !arena.is_measuring() && !parse_base_mesh(source.base, header, slots.base))
    {
        return false;
    }
    const Kernels& kernels = setup.kernels != nullptr ? *setup.kernels : best_kernels();
    model.emplace(arena, pools, id, header, slots, source.capacities, kernels);
    model->cache.set_variant(setup.variant);
    if (setup.static_when_it_fits && !comes_later && model->fits())
    {
        model->residence = Residence::filling;
    }
    return true;
}

} // namespace

FrameParts::FrameParts(Arena& arena, const FrameSetup& setup) noexcept
    : rules{setup.period_ns, setup.pose_age_max_ns, setup.prediction, setup.variant}
    , pools(arena, pool_capacities(setup), static_cast<std::uint32_t>(setup.models.size()))
    , models(arena, setup.models.size())
    , objects(arena, capacities_of(setup).objects)
    , tools(arena, setup)
    , pairs(arena, setup.tools, capacities_of(setup).pairs)
{
    rules.frame = ChunkCache::kFirstFrame;
    pools.cache.set_period(setup.period_ns);
    for (std::uint32_t i = 0; i < setup.models.size(); ++i)
    {
        std::optional<Model> measured;
        std::optional<Model>& model = arena.is_measuring() ? measured : models.next();
        if (!try_take_model(model, arena, pools, {i}, setup))
        {
            return;
        }
        if (!arena.is_measuring())
        {
            models.add(rules.frame);
        }
    }
}

} // namespace tactus
