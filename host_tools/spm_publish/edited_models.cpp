// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/edited_models.hpp"

#include "host_tools/build/build_model.hpp"
#include "host_tools/encode/decoded_model.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus
{

namespace
{

Vec3 point_of(const std::array<double, 3>& place)
{
    return {place[0], place[1], place[2]};
}

Result<SurfaceChange, Refusal> changed(SurfaceEditor& editor, const EditRequest& request)
{
    const Sweep sweep = sweep_of(request);
    switch (request.kind)
    {
    case EditKind::carve:
        return editor.carve(sweep);
    case EditKind::fill:
        return editor.fill(sweep);
    case EditKind::displace:
        break;
    }
    return editor.displace(sweep.from_m, request.radius_m,
                           request.amount_m * (sweep.rotation * Vec3(0.0, 0.0, 1.0)));
}

} // namespace

Sweep sweep_of(const EditRequest& request)
{
    const auto& q = request.from.rotation;
    Sweep sweep;
    sweep.radius_m = request.from.scale * request.radius_m;
    sweep.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    sweep.from_m = point_of(request.from.translation_m);
    sweep.to_m = point_of(request.to.translation_m);
    for (const std::array<double, 3>& vertex : request.hull_m)
    {
        sweep.core_m.emplace_back(request.from.scale * point_of(vertex));
    }
    if (sweep.core_m.empty())
    {
        const Vec3 half_axis_m = request.from.scale * point_of(request.half_axis_m);
        sweep.core_m = {half_axis_m};
        if (!half_axis_m.isZero())
        {
            sweep.core_m.emplace_back(-half_axis_m);
        }
    }
    return sweep;
}

Result<EditedModels, Refusal> EditedModels::create(dds::DdsServer& server, Log log)
{
    EditedModels edited(server, std::move(log));
    for (const dds::ModelPieces& model : server.models())
    {
        std::vector<std::string> damage;
        const DecodedModel decoded = DecodedModel::decode(model.store(), damage);
        if (!damage.empty())
        {
            return Refusal{damage.front()};
        }
        auto editor = SurfaceEditor::create(decoded, model.model().edit_room);
        if (!editor)
        {
            return Refusal{fmt::format("model '{}': {}", model.model().name, editor.error().text)};
        }
        edited.models_.push_back({std::move(editor).value(), {}});
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
    const auto change = changed(model.editor, request);
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

Result<HeaderFields, Refusal> EditedModels::save(std::size_t model,
                                                 const std::filesystem::path& path,
                                                 std::vector<std::string>& notes) const
{
    const ModelStore& store = server_->models()[model].store();
    const HeaderFields& fields = store.header().fields();
    const SurfaceEditor& editor = models_[model].editor;
    ModelOptions options;
    options.base_faces = fields.base_faces;
    options.keeps_winding = true;
    options.revision = fields.revision + editor.revision();
    // The same grid, so that vertices stay where they are.
    GridChoice grid;
    grid.place_m = fields.origin_m;
    grid.quantum_max_m = static_cast<double>(store.header().quantum_m());
    auto built = build_model(editor.surface(), store.path().string(), path, options, grid, notes);
    return built ? Result<HeaderFields, Refusal>(built.value().fields) : built.error();
}

} // namespace tactus
