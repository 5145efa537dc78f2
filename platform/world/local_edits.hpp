// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/edit/edited_model.hpp"
#include "platform/choices/messages.hpp"
#include "platform/loop/edit_mailbox.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_content.hpp"
#include "transport/log.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

namespace tactus::hrtc
{

class Controller;
class CutSender;
struct Options;
struct ProgramEdits;

/// Edits of a World's models of files, by calls of the program and by tools that carve. Any thread
/// but the haptic one; callers wait for each other, the haptic thread never. Edits reach the frame
/// in the order of the changes.
class LocalEdits
{
public:
    /// Edits of a change that still wait for frames; with more, further changes are refused.
    static constexpr std::size_t kWaitingMax = 1'024;
    using Change = std::function<Result<SurfaceChange, Refusal>(SurfaceEditor& editor)>;

    /// Decodes the models that have room for edits; null if none has. Refused if a tool is to
    /// carve, but has no volume, or no model has room.
    [[nodiscard]] static Result<std::unique_ptr<LocalEdits>, Refusal>
    create(const Controller& controller, const Options& options);
    LocalEdits(const LocalEdits&) = delete;
    LocalEdits& operator=(const LocalEdits&) = delete;
    /// Ends the thread of start().
    ~LocalEdits();

    /// What the haptic thread takes; it must not outlive this object.
    [[nodiscard]] ProgramEdits ports() noexcept;
    [[nodiscard]] bool has_room(std::size_t model) const { return models_.contains(model); }

    /// Changes a model that has room (asserted). Returns the volume in the model's frame, in m^3.
    [[nodiscard]] Result<double, Refusal> change(std::size_t model, const Change& change);
    /// Saves a model that has room (asserted) as EditedModel::save() does.
    [[nodiscard]] Result<Done, Refusal> save(std::size_t model, const std::string& path) const;

    /// Makes the changes of tools that carve, and passes edits on to the haptic thread. If another
    /// thread changes a model meanwhile, tools wait for the next step. One thread.
    void step();
    /// Starts a thread that calls step() every millisecond; stop() ends it.
    void start();
    void stop();

private:
    LocalEdits();

    [[nodiscard]] Result<double, Refusal> try_change(std::size_t model, const Change& change);
    void carve_by_tools();
    void end_refused();
    void pass_on();

    mutable std::mutex models_mutex_; ///< Guards the values of models_, and ended_.
    std::map<std::size_t, EditedModel> models_;
    std::set<std::size_t> ended_;      ///< Models of which a frame has refused an edit.
    mutable std::mutex waiting_mutex_; ///< Guards waiting_; taken after models_mutex_.
    std::deque<std::pair<ModelId, EditContent>> waiting_; ///< Edits on the way to the mailbox.
    // The thread of step():
    EditMailbox mailbox_;
    std::map<std::size_t, std::uint64_t> passed_on_; ///< Number of edits in the mailbox so far.
    std::unique_ptr<CutSender> cuts_;                ///< Null if no tool carves.
    RateLimitedLog log_{log_line};
    std::atomic<bool> is_stopping_{false};
    std::thread thread_;
};

} // namespace tactus::hrtc
