// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame_setup.hpp"

#include <algorithm>

namespace tactus
{

const char* refusal_text(FrameRefusal refusal) noexcept
{
    switch (refusal)
    {
    case FrameRefusal::too_many:
        return "there are too many tools, objects or models, or none";
    case FrameRefusal::unknown_model:
        return "an object or a tool names a model that is not loaded";
    case FrameRefusal::shared_model:
        return "a tool names a model that an object shows";
    case FrameRefusal::header_refused:
        return "a model's header is damaged";
    case FrameRefusal::base_refused:
        return "a model's base mesh is damaged";
    case FrameRefusal::memory_too_small:
        return "the pools are too small for the models";
    }
    return "the frame can't be made";
}

bool try_take_model(std::optional<Model>& model, Arena& arena, const ModelSource& source,
                    const FrameSetup& setup) noexcept
{
    const std::span<std::byte> header_bytes = arena.take<std::byte>(source.header.size());
    std::span<const std::byte> kept = source.header;
    if (!arena.is_measuring())
    {
        std::ranges::copy(source.header, header_bytes.begin());
        kept = header_bytes;
    }
    const ModelHeader header = ModelHeader::parse(kept).value();
    const PageSlots slots = PageSlots::take(arena, header.counts(), source.capacities.pages,
                                            source.capacities.index_pages);
    if (!arena.is_measuring() && !parse_base_mesh(source.base, header, slots.base))
    {
        return false;
    }
    const Kernels& kernels = setup.kernels != nullptr ? *setup.kernels : best_kernels();
    model.emplace(arena, header, slots, source.capacities, kernels);
    model->cache.set_period(setup.period_ns);
    if (setup.static_when_it_fits && model->fits())
    {
        model->residence = Residence::filling;
    }
    return true;
}

ToolSpec described(const ToolSpec& tool, const ModelHeader& header) noexcept
{
    ToolSpec spec = tool;
    if (auto* mesh = std::get_if<MeshCore>(&spec.core); mesh != nullptr)
    {
        const auto& extent = header.fields().extent_quanta;
        const auto quantum_m = static_cast<double>(header.quantum_m());
        mesh->origin_m = header.origin_m();
        mesh->extent_m = quantum_m * Vec3(extent[0], extent[1], extent[2]);
    }
    return spec;
}

std::optional<FrameRefusal> find_refusal(const FrameSetup& setup) noexcept
{
    if (setup.tools.empty() || setup.tools.size() > kMaxTools || setup.objects.empty() ||
        setup.objects.size() > kMaxObjects || setup.models.empty() ||
        setup.models.size() > kMaxModels)
    {
        return FrameRefusal::too_many;
    }
    for (const ObjectSpec& object : setup.objects)
    {
        if (object.model.value >= setup.models.size())
        {
            return FrameRefusal::unknown_model;
        }
    }
    for (const ToolSpec& tool : setup.tools)
    {
        const auto* mesh = std::get_if<MeshCore>(&tool.core);
        if (mesh != nullptr && mesh->model.value >= setup.models.size())
        {
            return FrameRefusal::unknown_model;
        }
        if (mesh != nullptr && std::ranges::any_of(setup.objects, [mesh](const ObjectSpec& object)
                                                   { return object.model == mesh->model; }))
        {
            return FrameRefusal::shared_model;
        }
    }
    for (const ModelSource& source : setup.models)
    {
        if (!ModelHeader::parse(source.header))
        {
            return FrameRefusal::header_refused;
        }
    }
    return std::nullopt;
}

} // namespace tactus
