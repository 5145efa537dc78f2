// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame_parts.hpp"

#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/similarity.hpp"

#include <algorithm>
#include <numbers>

namespace tactus
{

namespace
{

/// Number of faces under a tool that the work of a frame at 1 kHz allows, approximately.
constexpr double kFewFaces = 0.25 * kMaxLocalTriangles;

/// True if a tool on the model covers more than kFewFaces faces, assuming that they are spread
/// evenly over the sides of its box. With a force tolerance, such a model isn't refined as a whole.
bool is_too_fine(const FrameSetup& setup, ModelId id, const ModelHeader& header) noexcept
{
    if (setup.force_tolerance_n == 0.0)
    {
        return false;
    }
    const auto& extent = header.fields().extent_quanta;
    const auto quantum_m = static_cast<double>(header.quantum_m());
    const Vec3 sides_m = quantum_m * Vec3(extent[0], extent[1], extent[2]);
    const double area_sq_m =
        2.0 * (sides_m.x() * sides_m.y() + sides_m.y() * sides_m.z() + sides_m.z() * sides_m.x());
    const double faces = header.counts().base_faces + 2.0 * header.counts().records;
    double least_scale = kInfinity;
    for (std::size_t i = 0; i < setup.objects.size(); ++i)
    {
        const bool shows_it = setup.objects[i].model == id && i < setup.poses.size();
        least_scale = shows_it ? std::min(least_scale, setup.poses[i].scale) : least_scale;
    }
    return std::ranges::any_of(
        setup.tools,
        [&](const ToolSpec& tool)
        {
            if (is_mesh(tool) || tool.query_only)
            {
                return false;
            }
            const PlacedCore core(tool.core, Similarity{});
            const double radius_m =
                core.is_point() ? 0.0 : (core.radius() + tool.radius_m) / least_scale;
            return faces * radius_m * radius_m * std::numbers::pi > kFewFaces * area_sq_m;
        });
}

/// Copies the header, reads the base mesh and makes one model. False if the base mesh is damaged.
/// The header must parse.
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
    const bool comes_later = is_streamed_model(setup, id.value);
    const PageSlots slots =
        comes_later ? pools.slots.without_base() : pools.slots.of_model(arena, header.counts());
    if (!comes_later && !arena.is_measuring() && !parse_base_mesh(source.base, header, slots.base))
    {
        return false;
    }
    const Kernels& kernels = setup.kernels != nullptr ? *setup.kernels : best_kernels();
    model.emplace(arena, pools, id, header, slots, source.capacities, kernels);
    model->cache.set_variant(setup.variant);
    if (setup.static_when_it_fits && !comes_later && model->fits() &&
        !is_too_fine(setup, id, header))
    {
        model->residence = Residence::filling;
    }
    return true;
}

} // namespace

FrameParts::FrameParts(Arena& arena, const FrameSetup& setup) noexcept
    : rules{setup.period_ns, setup.pose_age_max_ns, setup.prediction, setup.force_tolerance_n,
            setup.variant}
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
