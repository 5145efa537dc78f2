// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/local_edits.hpp"

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/cut_sender.hpp"
#include "platform/controller/run_hooks.hpp"
#include "rt_core/base/assert.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>

#include <chrono>

namespace tactus::hrtc
{

namespace
{

/// Pause between two steps of the thread.
constexpr std::chrono::milliseconds kStepPause{1};

} // namespace

LocalEdits::LocalEdits() = default;

LocalEdits::~LocalEdits()
{
    stop();
}

Result<std::unique_ptr<LocalEdits>, Refusal> LocalEdits::create(const Controller& controller,
                                                                const Options& options)
{
    std::unique_ptr<LocalEdits> edits(new LocalEdits);
    auto cuts = CutSender::create(controller, options);
    if (!cuts)
    {
        return cuts.error();
    }
    edits->cuts_ = std::move(cuts).value();
    for (std::size_t i = 0; i < controller.models().size(); ++i)
    {
        const std::uint32_t room = controller.setup().models[i].capacities.edit_faces;
        if (room == 0)
        {
            continue;
        }
        const auto store = ModelStore::open(options.models[i]);
        if (!store)
        {
            return store.error();
        }
        auto model = EditedModel::create(store.value(), room);
        if (!model)
        {
            return failure(fmt::format("{}: {}", options.models[i], model.error().text));
        }
        edits->models_.emplace(i, std::move(model).value());
    }
    if (edits->cuts_ != nullptr && edits->models_.empty())
    {
        return failure("--edit: no model can be edited; set --edit-faces of an object");
    }
    return edits->models_.empty() ? nullptr : std::move(edits);
}

ProgramEdits LocalEdits::ports() noexcept
{
    return {&mailbox_, cuts_ != nullptr ? &cuts_->tap() : nullptr};
}

Result<double, Refusal> LocalEdits::change(std::size_t model, const Change& change)
{
    const std::lock_guard lock(models_mutex_);
    return try_change(model, change);
}

/// With models_mutex_.
Result<double, Refusal> LocalEdits::try_change(std::size_t model, const Change& change)
{
    TACTUS_ASSERT(has_room(model));
    if (ended_.contains(model))
    {
        return failure("a frame has refused an edit; the model gets no more");
    }
    {
        const std::lock_guard waiting(waiting_mutex_);
        if (waiting_.size() >= kWaitingMax)
        {
            return failure(fmt::format("{} edits wait for frames; at most {} are allowed",
                                       waiting_.size(), kWaitingMax));
        }
    }
    auto changed = change(models_.at(model).editor());
    if (!changed)
    {
        return changed.error();
    }
    const std::lock_guard waiting(waiting_mutex_);
    for (EditContent& edit : changed.value().edits)
    {
        waiting_.emplace_back(ModelId{static_cast<std::uint32_t>(model)}, std::move(edit));
    }
    return changed.value().volume_m3;
}

Result<Done, Refusal> LocalEdits::save(std::size_t model, const std::string& path) const
{
    TACTUS_ASSERT(has_room(model));
    // A copy, so that changes need not wait for the file.
    const EditedModel copy = [&]
    {
        const std::lock_guard lock(models_mutex_);
        return models_.at(model);
    }();
    std::vector<std::string> notes;
    const auto saved = copy.save(path, notes);
    if (!saved)
    {
        return saved.error();
    }
    for (const std::string& note : notes)
    {
        log_line(fmt::format("{}: note: {}", path, note));
    }
    return Done{};
}

void LocalEdits::step()
{
    end_refused();
    carve_by_tools();
    pass_on();
}

/// Ends the edits of a model after a frame has refused one: those behind it would be refused, too.
void LocalEdits::end_refused()
{
    if (const std::optional<ModelId> model = mailbox_.take_refused_model())
    {
        log_.write(
            fmt::format("model {}: a frame has refused an edit; it gets no more", model->value));
        const std::lock_guard lock(models_mutex_);
        ended_.insert(model->value);
    }
}

void LocalEdits::carve_by_tools()
{
    const std::unique_lock lock(models_mutex_, std::try_to_lock);
    if (cuts_ == nullptr || !lock.owns_lock())
    {
        return;
    }
    cuts_->step([this](std::size_t model) { return passed_on_[model]; },
                [this](std::size_t model, const EditRequest& request)
                {
                    if (!has_room(model))
                    {
                        return false;
                    }
                    const Sweep sweep = sweep_of(request);
                    const auto carved = try_change(model, [&](SurfaceEditor& editor)
                                                   { return editor.carve(sweep); });
                    if (!carved)
                    {
                        log_.write("an edit of a tool is refused: " + carved.error().text);
                    }
                    return carved.has_value();
                });
}

/// Passes edits to the mailbox until it is full.
void LocalEdits::pass_on()
{
    const std::lock_guard lock(waiting_mutex_);
    while (!waiting_.empty() && mailbox_.try_put(waiting_.front().first, waiting_.front().second))
    {
        ++passed_on_[waiting_.front().first.value];
        waiting_.pop_front();
    }
}

void LocalEdits::start()
{
    thread_ = std::thread(
        [this]
        {
            while (!is_stopping_.load())
            {
                step();
                std::this_thread::sleep_for(kStepPause);
            }
        });
}

void LocalEdits::stop()
{
    is_stopping_.store(true);
    if (thread_.joinable())
    {
        thread_.join();
    }
}

} // namespace tactus::hrtc
