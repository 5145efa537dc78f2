// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame_setup.hpp"

#include "rt_core/limits.hpp"

#include <algorithm>
#include <array>

namespace tactus
{

const char* refusal_text(FrameRefusal refusal) noexcept
{
    switch (refusal)
    {
    case FrameRefusal::too_many:
        return "too many tools, objects, pairs or models, or no tool or model";
    case FrameRefusal::too_many_faces:
        return "the pools have room for too many faces";
    case FrameRefusal::unknown_model:
        return "an object or a tool names a model that is not loaded";
    case FrameRefusal::shared_model:
        return "a tool names a model that an object shows";
    case FrameRefusal::header_refused:
        return "a model's header is damaged";
    case FrameRefusal::base_refused:
        return "a model's base mesh is damaged";
    case FrameRefusal::bad_tolerance:
        return "the force tolerance is not in 0 .. 0.1 N";
    case FrameRefusal::memory_too_small:
        return "the pools are too small for the models";
    }
    return "the frame can't be created";
}

ModelCapacities pool_capacities(const FrameSetup& setup) noexcept
{
    ModelCapacities sum = setup.for_streamed_models;
    for (const ModelSource& model : setup.models)
    {
        sum = sum_of(std::array{sum, model.capacities});
    }
    return sum;
}

SceneCapacities capacities_of(const FrameSetup& setup) noexcept
{
    SceneCapacities capacities = setup.capacities;
    capacities.objects =
        capacities.objects != 0
            ? capacities.objects
            : static_cast<std::uint32_t>(std::max<std::size_t>(setup.objects.size(), 1));
    const auto all = capacities.objects * static_cast<std::uint32_t>(setup.tools.size());
    capacities.pairs = capacities.pairs != 0 ? capacities.pairs : std::min(all, kMaxPairs);
    return capacities;
}

std::optional<FrameRefusal> find_refusal(const FrameSetup& setup) noexcept
{
    const SceneCapacities& capacities = setup.capacities;
    if (setup.tools.empty() || setup.tools.size() > kMaxTools || setup.models.empty() ||
        setup.models.size() > kMaxModels || capacities_of(setup).objects > kMaxObjects ||
        (capacities.objects != 0 && capacities.objects < setup.objects.size()) ||
        capacities.pairs > kMaxPairs)
    {
        return FrameRefusal::too_many;
    }
    const double tolerance_n = setup.force_tolerance_n;
    const bool is_taken = tolerance_n >= 0.0 && tolerance_n <= kForceToleranceMax_n;
    if (!is_taken) // The negated form refuses NaN, too.
    {
        return FrameRefusal::bad_tolerance;
    }
    std::uint64_t faces = setup.for_streamed_models.faces;
    for (const ModelSource& source : setup.models)
    {
        faces += source.capacities.faces + source.capacities.edit_faces;
    }
    if (faces > kMaxPoolFaces)
    {
        return FrameRefusal::too_many_faces;
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
        if (mesh != nullptr && (mesh->model.value >= setup.models.size() ||
                                is_streamed_model(setup, mesh->model.value) ||
                                setup.models[mesh->model.value].capacities.edit_faces > 0))
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
        if (source.capacities.edit_faces > kMaxAddedFaces)
        {
            return FrameRefusal::too_many_faces;
        }
    }
    return std::nullopt;
}

} // namespace tactus
