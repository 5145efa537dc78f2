// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/build_scene.hpp"

#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/unique_names.hpp"
#include "platform/base/atomic_file.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
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

/// Which meshes become models, and who shows them.
struct Plan
{
    std::vector<MeshUse> meshes;    ///< One a model.
    std::vector<std::string> names; ///< Likewise.
    PlacedModels scene;
};

ContentHash hash_of(const TriangleMesh& mesh)
{
    const std::array<ContentHash, 2> parts{content_hash(std::as_bytes(std::span(mesh.positions))),
                                           content_hash(std::as_bytes(std::span(mesh.faces)))};
    return content_hash(std::as_bytes(std::span(parts)));
}

/// Reads every mesh once; equal ones become one model.
Result<Plan, Refusal> plan_models(Scene& scene, const fs::path& input)
{
    Plan plan;
    std::map<MeshUse, std::size_t> by_use;
    std::map<ContentHash, std::size_t> by_content;
    for (const SceneObject& object : scene.objects())
    {
        if (!object.is_touched)
        {
            continue;
        }
        if (!object.mesh)
        {
            return Refusal{fmt::format("{}: {} names its model already; only meshes are encoded",
                                       input.string(), object.place)};
        }
        if (!by_use.contains(*object.mesh))
        {
            const auto mesh = scene.read_mesh(*object.mesh);
            if (!mesh)
            {
                return mesh.error();
            }
            const auto [model, is_new] =
                by_content.try_emplace(hash_of(mesh.value()), plan.meshes.size());
            by_use[*object.mesh] = model->second;
            if (is_new)
            {
                plan.meshes.push_back(*object.mesh);
                plan.names.push_back(plain_name(scene.mesh_name(*object.mesh) +
                                                (object.mesh->is_mirrored ? "-mirrored" : "")));
            }
        }
        plan.scene.objects.push_back(
            {object.name, by_use.at(*object.mesh), object.pose, object.material});
    }
    plan.names = unique_names(plan.names);
    for (const std::string& name : plan.names)
    {
        plan.scene.files.emplace_back(name + ".spm");
    }
    return plan;
}

/// The folder that gets the result, and one in it for what is not finished. Removes what it made,
/// unless all is done.
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
            fs::remove(path_, ignored); // Only when it is empty.
        }
    }

    [[nodiscard]] const fs::path& partial() const noexcept { return partial_; }

    /// Gives the files of the partial folder their places.
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

Result<SceneModel, Refusal> build_one(Scene& scene, const Plan& plan, std::size_t number,
                                      const fs::path& input, const fs::path& folder,
                                      const ModelOptions& options)
{
    const auto mesh = scene.read_mesh(plan.meshes[number]);
    if (!mesh)
    {
        return mesh.error();
    }
    SceneModel model{.name = plan.names[number], .outcome = {}, .notes = {}};
    auto outcome =
        build_model(mesh.value(), fmt::format("{}: mesh of {}", input.string(), model.name),
                    folder / plan.scene.files[number], options, model.notes);
    if (!outcome)
    {
        return outcome.error();
    }
    model.outcome = outcome.value();
    return model;
}

Result<SceneOutcome, Refusal> build_planned(Scene& scene, const Plan& plan, const fs::path& input,
                                            const fs::path& folder, const ModelOptions& options)
{
    auto target = TargetFolder::create(folder);
    if (!target)
    {
        return target.error();
    }
    SceneOutcome outcome{
        .file = folder / kSceneFile, .objects = plan.scene.objects.size(), .models = {}};
    auto file = AtomicFile::create(outcome.file); // Before the work: is there leave to write?
    if (!file)
    {
        return file.error();
    }
    for (std::size_t i = 0; i < plan.meshes.size(); ++i)
    {
        auto model = build_one(scene, plan, i, input, target.value().partial(), options);
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
                                          const ModelOptions& options)
{
    auto scene = Scene::open(input);
    if (!scene)
    {
        return scene.error();
    }
    const auto plan = plan_models(scene.value(), input);
    if (!plan)
    {
        return plan.error();
    }
    return build_planned(scene.value(), plan.value(), input, folder, options);
}

} // namespace tactus::spm_build
