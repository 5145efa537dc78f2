// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/edited_models.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus
{

Result<EditedModels, Refusal> EditedModels::create(dds::DdsServer& server, Log log)
{
    EditedModels edited(server, std::move(log));
    for (const dds::ModelPieces& model : server.models())
    {
        auto surface = EditedModel::create(model.store(), model.model().edit_room);
        if (!surface)
        {
            return Refusal{fmt::format("model '{}': {}", model.model().name, surface.error().text)};
        }
        edited.models_.push_back({std::move(surface).value(), {}});
    }
    return edited;
}

void EditedModels::step()
{
    for (std::size_t i = 0; i < kChangesAtOnce; ++i)
    {
        const auto request = server_->edits()->take();
        if (!request)
        {
            return;
        }
        change(*request);
    }
}

void EditedModels::change(const EditRequest& request)
{
    Edited& model = models_[request.model];
    const auto change = model.surface.change(request);
    if (!change)
    {
        ++model.counts.refused;
        log_.write(fmt::format("model '{}': an edit is refused: {}",
                               server_->models()[request.model].model().name, change.error().text));
        return;
    }
    if (change.value().edits.empty())
    {
        return; // The tool was clear of the surface.
    }
    ++model.counts.changes;
    const double volume_m3 = change.value().volume_m3;
    (request.kind == EditKind::carve ? model.counts.removed_m3 : model.counts.gained_m3) +=
        volume_m3;
    if (const auto refusal = server_->edits()->publish(request.model, change.value().edits))
    {
        // The editor and the publisher have the same rules, so this is a fault of the program.
        log_.write(refusal->text);
    }
}

} // namespace tactus
