// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/edited_model.hpp"

#include "host_tools/build/build_model.hpp"
#include "host_tools/encode/decoded_model.hpp"

#include <array>

namespace tactus
{

namespace
{

Vec3 point_of(const std::array<double, 3>& place)
{
    return {place[0], place[1], place[2]};
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

Result<EditedModel, Refusal> EditedModel::create(const ModelStore& store, std::uint32_t room)
{
    std::vector<std::string> damage;
    const DecodedModel decoded = DecodedModel::decode(store, damage);
    if (!damage.empty())
    {
        return Refusal{damage.front()};
    }
    auto editor = SurfaceEditor::create(decoded, room);
    return editor ? Result<EditedModel, Refusal>(EditedModel(std::move(editor).value(), store))
                  : editor.error();
}

Result<SurfaceChange, Refusal> EditedModel::change(const EditRequest& request)
{
    const Sweep sweep = sweep_of(request);
    switch (request.kind)
    {
    case EditKind::carve:
        return editor_.carve(sweep);
    case EditKind::fill:
        return editor_.fill(sweep);
    case EditKind::displace:
        break;
    }
    return editor_.displace(sweep.from_m, request.radius_m,
                            request.amount_m * (sweep.rotation * Vec3(0.0, 0.0, 1.0)));
}

Result<HeaderFields, Refusal> EditedModel::save(const std::filesystem::path& path,
                                                std::vector<std::string>& notes) const
{
    ModelOptions options;
    options.base_faces = fields_.base_faces;
    options.keeps_winding = true;
    options.revision = fields_.revision + editor_.revision();
    // The same grid, so that vertices stay where they are.
    GridChoice grid;
    grid.place_m = fields_.origin_m;
    grid.quantum_max_m = quantum_m_;
    auto built = build_model(editor_.surface(), source_, path, options, grid, notes);
    return built ? Result<HeaderFields, Refusal>(built.value().fields) : built.error();
}

} // namespace tactus
