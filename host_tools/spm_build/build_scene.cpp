// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/build_scene.hpp"

#include "host_tools/scene/common_places.hpp"
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/spm_build/scene_plan.hpp"
#include "platform/program/progress.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>

#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace tactus::spm_build
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* kSceneFile = "scene.gltf";

/// The target folder, and a folder in it for unfinished files. The destructor removes that folder,
/// and the target folder if it was created here and is empty.
class TargetFolder
{
public:
    static Result<TargetFolder, Refusal> create(const fs::path& path)
    {
        TargetFolder folder(path);
        std::error_code code;
        folder.is_new_ = fs::create_directory(path, code);
        if (!code)
        {
            fs::create_directory(folder.partial_, code);
        }
        if (code)
        {
            return Refusal{fmt::format("{}: can't be written: {}", path.string(), code.message())};
        }
        folder.has_partial_ = true;
        return folder;
    }

    TargetFolder(TargetFolder&& other) noexcept
        : path_(std::move(other.path_))
        , partial_(std::move(other.partial_))
        , is_new_(std::exchange(other.is_new_, false))
        , has_partial_(std::exchange(other.has_partial_, false))
    {
    }
    TargetFolder& operator=(TargetFolder&&) = delete;
    TargetFolder(const TargetFolder&) = delete;
    TargetFolder& operator=(const TargetFolder&) = delete;
    ~TargetFolder()
    {
        std::error_code ignored;
        if (has_partial_)
        {
            fs::remove_all(partial_, ignored);
        }
        if (is_new_)
        {
            fs::remove(path_, ignored); // Succeeds only if it is empty.
        }
    }

    [[nodiscard]] const fs::path& partial() const noexcept { return partial_; }

    /// Moves the files of the partial folder into place.
    [[nodiscard]] std::optional<Refusal> finish(const std::vector<fs::path>& names)
    {
        for (const fs::path& name : names)
        {
            std::error_code code;
            fs::rename(partial_ / name, path_ / name, code);
            if (code)
            {
                return Refusal{fmt::format("{}: can't be written: {}", (path_ / name).string(),
                                           code.message())};
            }
        }
        return std::nullopt;
    }

private:
    explicit TargetFolder(const fs::path& path)
        : path_(path), partial_(path / fmt::format("{}.partial", getpid()))
    {
    }

    fs::path path_;
    fs::path partial_;
    bool is_new_{false};
    bool has_partial_{false};
};

/// Common vertices of each group's models, by the group's first model.
using GroupPlaces = std::map<std::size_t, CommonPlaces>;

Result<SceneModel, Refusal> build_one(Scene& scene, const ScenePlan& plan, std::size_t number,
                                      GroupPlaces& places, const fs::path& input,
                                      const fs::path& folder, const ModelOptions& options)
{
    auto mesh = scene.read_mesh(plan.meshes[number]);
    if (!mesh)
    {
        return mesh.error();
    }
    GridChoice grid = plan.grids[number];
    if (grid.quantum_max_m)
    {
        CommonPlaces& common =
            places.try_emplace(plan.groups[number], *grid.quantum_max_m).first->second;
        grid.moved_m =
            common.settle(mesh.value().mesh, Vec3(grid.place_m.data()), boxes_beside(plan, number));
        grid.beside_m = vertices_beside(plan, number);
    }
    SceneModel model{.name = plan.names[number], .outcome = {}, .notes = {}};
    auto outcome = build_model(mesh.value().mesh, source_of(input, model.name),
                               folder / plan.scene.files[number], options, grid, model.notes);
    if (!outcome)
    {
        return outcome.error();
    }
    model.outcome = outcome.value();
    return model;
}

Result<SceneOutcome, Refusal> build_planned(Scene& scene, const ScenePlan& plan,
                                            const fs::path& input, const fs::path& folder,
                                            const ModelOptions& options)
{
    auto target = TargetFolder::create(folder);
    if (!target)
    {
        return target.error();
    }
    SceneOutcome outcome{.file = folder / kSceneFile,
                         .objects = plan.scene.objects.size(),
                         .models = {},
                         .notes = plan.notes};
    auto file = AtomicFile::create(outcome.file); // Tests the permission to write before the work.
    if (!file)
    {
        return file.error();
    }
    Progress progress("spm_build", "build", "faces");
    const std::size_t all = std::accumulate(plan.faces.begin(), plan.faces.end(), std::size_t{0});
    std::size_t built = 0;
    GroupPlaces places;
    for (std::size_t i = 0; i < plan.meshes.size(); ++i)
    {
        ModelOptions with_progress = options;
        with_progress.progress = [&](double share)
        {
            const double of_this = share * static_cast<double>(plan.faces[i]);
            progress.update(built + static_cast<std::size_t>(of_this), all);
        };
        auto model =
            build_one(scene, plan, i, places, input, target.value().partial(), with_progress);
        built += plan.faces[i];
        if (!model)
        {
            return model.error();
        }
        outcome.models.push_back(std::move(model).value());
    }
    for (const PlacedModel& object : plan.scene.objects)
    {
        ++outcome.models[object.model].objects;
    }
    const std::string text = scene_text(plan.scene);
    if (const auto written = file.value().write(std::as_bytes(std::span(text))); !written)
    {
        return written.error();
    }
    if (const auto refused = target.value().finish(plan.scene.files))
    {
        return *refused;
    }
    if (const auto done = file.value().commit(); !done)
    {
        return done.error();
    }
    return outcome;
}

} // namespace

Result<SceneOutcome, Refusal> build_scene(const fs::path& input, const fs::path& folder,
                                          const ModelOptions& options, const Placing& placing)
{
    auto scene = Scene::open(input);
    if (!scene)
    {
        return scene.error();
    }
    auto plan = plan_models(scene.value(), input);
    if (!plan)
    {
        return plan.error();
    }
    // Placing transforms all objects and their grids alike, so models do not depend on it.
    if (const auto refused = choose_grids(scene.value(), plan.value(), input, options))
    {
        return *refused;
    }
    if (auto refused = place_objects(placing, plan.value().boxes, plan.value().scene.objects,
                                     plan.value().notes))
    {
        return *refused;
    }
    return build_planned(scene.value(), plan.value(), input, folder, options);
}

} // namespace tactus::spm_build
