// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "platform/choices/messages.hpp"
#include "platform/world/program_devices.hpp"
#include "platform/world/world_plan.hpp"
#include "platform/world/world_values.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <exception>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Exception of a progress callback, with its text.
struct CallbackThrew
{
    std::string text;
};

Result<TriangleMesh, Refusal> mesh_of(const WorldModel& model, const std::string& source)
{
    if (model.kind == WorldModel::Kind::mesh_file)
    {
        return read_mesh(model.text);
    }
    for (std::size_t i = 0; i < model.faces.size(); ++i)
    {
        for (const std::uint32_t corner : model.faces[i])
        {
            if (corner >= model.vertices.size())
            {
                return failure(fmt::format("{}: face {} names vertex {}; there are {}", source, i,
                                           corner, model.vertices.size()));
            }
        }
    }
    return TriangleMesh{model.vertices, model.faces};
}

Result<ModelOptions, Refusal> options_of(const MeshOptions& options)
{
    const auto unit = metres_per_unit(options.unit);
    if (!unit)
    {
        return failure(fmt::format("unit: '{}' is not m, cm, mm, in or inch", options.unit));
    }
    ModelOptions made;
    made.metres_per_unit = *unit;
    made.fit_diagonal_m = options.fit_diagonal_m;
    made.is_centered = options.is_centered;
    if (options.progress)
    {
        made.progress = [told = options.progress](double share)
        {
            const CallbackScope
                scope; // A call of the World would wait for add(), which waits here.
            try
            {
                told(share);
            }
            catch (const std::exception& exception)
            {
                throw CallbackThrew{exception.what()};
            }
            catch (...)
            {
                throw CallbackThrew{"no std::exception"};
            }
        };
    }
    return made;
}

} // namespace

MeshFolder::~MeshFolder()
{
    if (!folder_.empty())
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
}

Result<std::filesystem::path, Refusal> MeshFolder::file_for(const std::string& name)
{
    if (!is_valid_name(name))
    {
        return failure(fmt::format("name: '{}' is not {}", name, kNameForm));
    }
    if (folder_.empty())
    {
        std::error_code code;
        std::string form = (std::filesystem::temp_directory_path(code) / "tactus-XXXXXX").string();
        if (code || ::mkdtemp(form.data()) == nullptr)
        {
            return failure(fmt::format("{}: no folder for encoded meshes can be made", form));
        }
        folder_ = form;
    }
    // A folder of its own for each, since two models may have one name.
    const std::filesystem::path folder = folder_ / std::to_string(count_++);
    std::error_code code;
    std::filesystem::create_directory(folder, code);
    return code ? Result<std::filesystem::path, Refusal>(
                      failure(folder.string() + ": " + code.message()))
                : folder / (name + ".spm");
}

Result<std::string, Refusal> MeshFolder::encode(const WorldModel& model)
{
    const bool is_file = model.kind == WorldModel::Kind::mesh_file;
    const std::string stem = std::filesystem::path(model.text).stem().string();
    const std::string own = is_file && is_valid_name(stem) ? stem : fmt::format("mesh-{}", count_);
    const std::string name = model.options.name.empty() ? own : model.options.name;
    const std::string source = is_file ? model.text : name;
    auto options = options_of(model.options);
    if (!options)
    {
        return options.error();
    }
    auto made = mesh_of(model, source);
    if (!made)
    {
        return made.error();
    }
    const auto path = file_for(name);
    if (!path)
    {
        return path.error();
    }
    std::vector<std::string> notes;
    try
    {
        const auto built =
            build_model(made.value(), source, path.value(), options.value(), {}, notes);
        if (!built)
        {
            return in_world_words(built.error());
        }
    }
    catch (const CallbackThrew& thrown)
    {
        return failure(
            fmt::format("{}: the progress callback has thrown: {}", source, thrown.text));
    }
    for (const std::string& note : notes)
    {
        log_line(fmt::format("{}: note: {}", source, note));
    }
    return path.value().string();
}

} // namespace tactus::hrtc
