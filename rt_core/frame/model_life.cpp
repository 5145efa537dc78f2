// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model_life.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/model_set.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <limits>

namespace tactus
{

namespace
{

/// Time that a model stays without a pair, so that it isn't loaded each time that a user goes back
/// and forth.
constexpr std::int64_t kLinger_ns = 2'000'000'000;

} // namespace

ModelLife::ModelLife(std::int64_t period_ns) noexcept
    : linger_frames_(static_cast<std::uint32_t>(std::clamp<std::int64_t>(
          kLinger_ns / period_ns, 1, std::numeric_limits<std::uint32_t>::max())))
{
}

void ModelLife::advance(ModelSet& models, std::span<Pair* const> pairs, std::uint32_t frame,
                        WorkCounters& work) noexcept
{
    Turn turn{kEnteringFacesPerFrame, kLeavingFacesPerFrame};
    for (const Pair* pair : pairs)
    {
        Model& model = models[pair->parts().model.id];
        want(models, *pair, frame, turn);
        // The loop below handles leaving models, once a frame, as a refit must lie between their
        // steps.
        if (model.stage != ModelStage::leaving)
        {
            advance(model, turn, frame, work);
        }
    }
    for (const ModelId id : models.busy())
    {
        advance(models[id], turn, frame, work);
    }
    let_go(models, frame);
    if (turn.waits != nullptr && !turn.gave_room)
    {
        make_room(models, pairs, *turn.waits, frame);
    }
}

void ModelLife::advance(Model& model, Turn& turn, std::uint32_t frame, WorkCounters& work) noexcept
{
    const bool had_room = model.stage != ModelStage::known;
    model.advance(turn.entering, turn.leaving, frame, work);
    turn.gave_room = turn.gave_room || (had_room && model.stage == ModelStage::known);
}

void ModelLife::want(ModelSet& models, const Pair& pair, std::uint32_t frame, Turn& turn) noexcept
{
    Model& model = models[pair.parts().model.id];
    // Memory is kept for a waiting model of higher priority.
    if (model.may_come(frame) && turn.waits == nullptr && !model.try_want())
    {
        turn.waits = &pair;
    }
}

/// Lets one streamed model leave if it has been without a pair for linger_frames_. Each frame
/// checks one model.
void ModelLife::let_go(ModelSet& models, std::uint32_t frame) const noexcept
{
    TACTUS_ASSERT(models.size() > 0);
    const ModelId turn{frame % models.size()};
    if (Model& model = models[turn]; model.is_streamed_model && model.is_resident() &&
                                     frame - models.slot(turn).paired_frame > linger_frames_)
    {
        model.leave();
        models.keep_busy(turn);
    }
}

/// Makes the model leave that matters least, unless a model is leaving already.
void ModelLife::make_room(ModelSet& models, std::span<Pair* const> pairs, const Pair& waits,
                          std::uint32_t frame) noexcept
{
    for (std::uint32_t i = 0; i < models.size(); ++i)
    {
        if (models[{i}].stage == ModelStage::leaving)
        {
            return;
        }
    }
    std::optional<ModelId> goes = find_left(models, frame);
    goes = goes ? goes : find_spare(models, pairs, waits);
    if (!goes)
    {
        return;
    }
    for (Pair* pair : pairs)
    {
        if (pair->parts().model.id == *goes)
        {
            models[*goes].refiner.release(pair->object_closure());
            pair->lose_model();
        }
    }
    models[*goes].leave();
    models.keep_busy(*goes);
}

/// Finds the streamed model without a pair for the longest time; none if all have one.
std::optional<ModelId> ModelLife::find_left(const ModelSet& models, std::uint32_t frame) noexcept
{
    std::uint32_t longest = 0;
    std::optional<ModelId> left;
    for (std::uint32_t i = 0; i < models.size(); ++i)
    {
        const Model& model = models[{i}];
        const std::uint32_t since = frame - models.slot({i}).paired_frame;
        if (model.is_streamed_model && model.is_resident() && since > longest)
        {
            longest = since;
            left = ModelId{i};
        }
    }
    return left;
}

/// Finds the streamed model whose highest-priority pair comes last. All its pairs must be able to
/// spare it. Contact must be kLaterContact times as far in time as for `waits`, so that the two do
/// not swap at once.
std::optional<ModelId> ModelLife::find_spare(const ModelSet& models, std::span<Pair* const> pairs,
                                             const Pair& waits) noexcept
{
    constexpr double kLaterContact = 2.0;
    for (std::size_t i = pairs.size(); i-- > 0;)
    {
        const ModelId id = pairs[i]->parts().model.id;
        const auto is_of_it = [id](const Pair* pair) { return pair->parts().model.id == id; };
        const bool is_later =
            pairs[i]->priority().contact_s > kLaterContact * waits.priority().contact_s;
        if (!is_later)
        {
            return std::nullopt; // Pairs of higher priority are even nearer to contact.
        }
        if (models[id].is_streamed_model && models[id].is_resident() &&
            std::ranges::none_of(pairs.first(i), is_of_it) &&
            std::ranges::all_of(pairs.subspan(i), [&](const Pair* pair)
                                { return !is_of_it(pair) || pair->can_spare_model(); }))
        {
            return id;
        }
    }
    return std::nullopt;
}

} // namespace tactus
