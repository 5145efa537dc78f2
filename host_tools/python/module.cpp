// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/c/tactus.h"
#include "host_tools/python/arrays.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace py = pybind11;
using namespace tactus_python;

namespace
{

// --- Models --------------------------------------------------------------------------------------

class Model
{
public:
    explicit Model(const std::string& path)
    {
        check([&](tactus_error* error)
              { return tactus_model_open(TACTUS_ABI, path.c_str(), &model_, error); });
        read_info();
    }
    Model(const std::string& name, std::uint32_t domain, double wait_s)
    {
        check_unlocked(
            [&](tactus_error* error) {
                return tactus_model_find(TACTUS_ABI, name.c_str(), domain, wait_s, &model_, error);
            });
        read_info();
    }
    Model(const Model&) = delete;
    Model& operator=(const Model&) = delete;
    ~Model() { tactus_model_close(model_, nullptr); }

    [[nodiscard]] tactus_model* get() const { return model_; }
    [[nodiscard]] const tactus_model_info& info() const { return info_; }

private:
    void read_info()
    {
        info_.size = sizeof(info_);
        check([&](tactus_error* error) { return tactus_model_info_of(model_, &info_, error); });
    }

    tactus_model* model_{nullptr};
    tactus_model_info info_{};
};

// --- Set-up --------------------------------------------------------------------------------------

tactus_tool make_tool(double radius_m, const std::string& shape, const py::object& half_m,
                      bool query_only, bool wants_distance,
                      const std::optional<double>& stiffness_n_per_m,
                      const std::optional<double>& force_max_n,
                      const std::optional<double>& torque_max_nm,
                      const std::optional<double>& speed_max_m_per_s, double shading_m)
{
    tactus_tool tool;
    tactus_tool_default(&tool);
    if (shape != "sphere" && shape != "capsule" && shape != "box")
    {
        throw py::value_error("shape: '" + shape + "'; sphere, capsule or box is needed");
    }
    tool.shape = shape == "sphere"    ? TACTUS_SPHERE
                 : shape == "capsule" ? TACTUS_CAPSULE
                                      : TACTUS_BOX;
    tool.radius_m = radius_m;
    if (!half_m.is_none())
    {
        const Numbers half = numbers_of(half_m, "half_m");
        check_shape(half, {3}, "half_m");
        std::copy_n(half.data(), 3, tool.half_m);
    }
    tool.query_only = query_only ? 1 : 0;
    tool.wants_distance = wants_distance ? 1 : 0;
    tool.stiffness_n_per_m = stiffness_n_per_m.value_or(tool.stiffness_n_per_m);
    tool.force_max_n = force_max_n.value_or(tool.force_max_n);
    tool.torque_max_nm = torque_max_nm.value_or(tool.torque_max_nm);
    tool.speed_max_m_per_s = speed_max_m_per_s.value_or(tool.speed_max_m_per_s);
    tool.shading_m = shading_m;
    return tool;
}

tactus_object make_object(std::uint32_t model, const py::object& rotation,
                          const py::object& translation_m, double scale, double static_friction,
                          double dynamic_friction)
{
    tactus_object object;
    tactus_object_default(&object);
    object.model = model;
    read_pose(object.pose, rotation, translation_m, scale);
    object.static_friction = static_friction;
    object.dynamic_friction = dynamic_friction;
    return object;
}

/// Result of run(); N poses, T tools, J objects.
struct Answers
{
    py::array_t<double> force_n;
    py::array_t<double> torque_nm;
    py::array_t<double> proxy_m;
    py::array_t<std::uint32_t> flags;
    py::array_t<double> lower_m;
    py::array_t<double> upper_m;
    py::array_t<std::uint8_t> kind;
    py::array_t<double> nearest_m;
};

struct AlignedDelete
{
    void operator()(std::byte* bytes) const
    {
        ::operator delete (bytes, std::align_val_t{TACTUS_ALIGNMENT});
    }
};

class Frame
{
public:
    Frame(std::vector<std::shared_ptr<Model>> models, const std::vector<tactus_tool>& tools,
          const std::vector<tactus_object>& objects, double memory_mib, double period_s,
          bool loads_whole, double object_speed_max_m_per_s)
        : models_(std::move(models)), tools_(tools.size()), objects_(objects.size())
    {
        if (!(memory_mib >= 0.1 && memory_mib <= 65'536.0))
        {
            throw py::value_error("memory_mib: " + std::to_string(memory_mib) +
                                  "; 0.1 to 65536 is allowed");
        }
        const auto bytes = static_cast<std::size_t>(memory_mib * 1048576.0);
        memory_.reset(
            static_cast<std::byte*>(::operator new (bytes, std::align_val_t{TACTUS_ALIGNMENT})));
        std::vector<tactus_model*> handles;
        for (const std::shared_ptr<Model>& model : models_)
        {
            handles.push_back(model->get());
        }
        tactus_setup setup;
        tactus_setup_default(&setup);
        setup.models = handles.data();
        setup.model_count = static_cast<std::uint32_t>(handles.size());
        setup.tools = tools.data();
        setup.tool_count = static_cast<std::uint32_t>(tools.size());
        setup.objects = objects.data();
        setup.object_count = static_cast<std::uint32_t>(objects.size());
        if (!(period_s >= 1e-5 && period_s <= 1.0))
        {
            throw py::value_error("period_s: " + std::to_string(period_s) +
                                  "; 1e-5 to 1 is allowed");
        }
        setup.period_ns = static_cast<std::int64_t>(period_s * 1e9 + 0.5);
        setup.loads_whole = loads_whole ? 1 : 0;
        setup.object_speed_max_m_per_s = object_speed_max_m_per_s;
        check([&](tactus_error* error)
              { return tactus_frame_make(&setup, memory_.get(), bytes, &frame_, error); });
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    ~Frame() { tactus_frame_end(frame_); }

    Answers run(const py::object& positions_m, const py::object& rotations, std::uint32_t rounds)
    {
        const Numbers positions = numbers_of(positions_m, "positions_m");
        // The tools' axis may be omitted.
        const bool is_flat = tools_ == 1 && positions.ndim() == 2;
        const py::ssize_t count = positions.ndim() > 0 ? positions.shape(0) : 0;
        std::vector<py::ssize_t> shape{count};
        if (!is_flat)
        {
            shape.push_back(static_cast<py::ssize_t>(tools_));
        }
        const auto with = [&shape](std::vector<py::ssize_t> more)
        {
            more.insert(more.begin(), shape.begin(), shape.end());
            return more;
        };
        check_shape(positions, with({3}), "positions_m");
        Numbers turned;
        tactus_poses poses{};
        if (!rotations.is_none())
        {
            turned = numbers_of(rotations, "rotations");
            check_shape(turned, with({3, 3}), "rotations");
            poses.rotations = turned.data();
        }
        const auto objects = static_cast<py::ssize_t>(objects_);
        Answers answers{py::array_t<double>(with({3})),
                        py::array_t<double>(with({3})),
                        py::array_t<double>(with({3})),
                        py::array_t<std::uint32_t>(shape),
                        py::array_t<double>(with({objects})),
                        py::array_t<double>(with({objects})),
                        py::array_t<std::uint8_t>(with({objects})),
                        py::array_t<double>(with({objects, 3}))};
        poses.size = sizeof(poses);
        poses.count = static_cast<std::size_t>(count);
        poses.positions_m = positions.data();
        poses.force_n = answers.force_n.mutable_data();
        poses.torque_nm = answers.torque_nm.mutable_data();
        poses.proxy_m = answers.proxy_m.mutable_data();
        poses.flags = answers.flags.mutable_data();
        poses.lower_m = answers.lower_m.mutable_data();
        poses.upper_m = answers.upper_m.mutable_data();
        poses.kind = answers.kind.mutable_data();
        poses.nearest_m = answers.nearest_m.mutable_data();
        poses.rounds = rounds;
        if (count > 0 && std::exchange(is_new_, false))
        {
            warn_of_insides(positions.data());
        }
        check_unlocked([&](tactus_error* error)
                       { return tactus_frame_run(frame_, &poses, error); });
        return answers;
    }

    /// Warns about tools that begin inside; has the refusals of tactus_frame_run().
    void warn_of_insides(const double* positions_m) const
    {
        std::vector<std::uint8_t> inside(tools_);
        check([&](tactus_error* error)
              { return tactus_frame_begins_inside(frame_, positions_m, inside.data(), error); });
        for (std::size_t tool = 0; tool < inside.size(); ++tool)
        {
            const std::string text =
                "tool " + std::to_string(tool) +
                " begins inside a closed object, whose surface keeps it inside";
            if (inside[tool] != 0 && PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0)
            {
                throw py::error_already_set(); // Warnings may be errors.
            }
        }
    }

    void load()
    {
        check_unlocked([&](tactus_error* error) { return tactus_frame_load(frame_, error); });
    }

    void place(std::uint32_t object, const py::object& rotation, const py::object& translation_m,
               double scale)
    {
        tactus_object at;
        tactus_object_default(&at);
        read_pose(at.pose, rotation, translation_m, scale);
        check([&](tactus_error* error)
              { return tactus_frame_place(frame_, object, &at.pose, error); });
    }

    void feel(std::uint32_t object, double stiffness_n_per_m, double static_friction,
              double dynamic_friction, double damping_n_s_per_m, double viscosity_n_s_per_m,
              double texture_height_m, double texture_length_m)
    {
        const tactus_material material =
            material_of(stiffness_n_per_m, static_friction, dynamic_friction, damping_n_s_per_m,
                        viscosity_n_s_per_m, texture_height_m, texture_length_m);
        check([&](tactus_error* error)
              { return tactus_frame_feel(frame_, object, &material, error); });
    }

    [[nodiscard]] py::dict state() const
    {
        tactus_frame_state state{};
        state.size = sizeof(state);
        check([&](tactus_error* error) { return tactus_frame_state_of(frame_, &state, error); });
        using namespace py::literals;
        return py::dict("frames"_a = state.frames, "pages_used"_a = state.pages_used,
                        "pages_total"_a = state.pages_total, "faces_used"_a = state.faces_used,
                        "is_whole"_a = state.is_whole != 0);
    }

private:
    /// Models, which outlive the frame, as does the memory.
    std::vector<std::shared_ptr<Model>> models_;
    std::size_t tools_;
    std::size_t objects_;
    std::unique_ptr<std::byte, AlignedDelete> memory_;
    tactus_frame* frame_{nullptr};
    bool is_new_{true}; ///< True before the first frame.
};

/// Distances of N points.
struct Distances
{
    py::array_t<double> lower_m;
    py::array_t<double> upper_m;
    py::array_t<std::uint8_t> side;
    py::array_t<double> nearest_m; ///< Array of N x 3.
};

class StaticModel
{
public:
    explicit StaticModel(const std::string& path)
    {
        check_unlocked(
            [&](tactus_error* error)
            { return tactus_static_model_open(TACTUS_ABI, path.c_str(), &model_, error); });
    }
    StaticModel(const StaticModel&) = delete;
    StaticModel& operator=(const StaticModel&) = delete;
    ~StaticModel() { tactus_static_model_close(model_); }

    [[nodiscard]] Distances distances(const py::object& points_m) const
    {
        const Numbers points = numbers_of(points_m, "points_m");
        const py::ssize_t count = points.ndim() > 0 ? points.shape(0) : 0;
        check_shape(points, {count, 3}, "points_m");
        Distances answers{py::array_t<double>(count), py::array_t<double>(count),
                          py::array_t<std::uint8_t>(count),
                          py::array_t<double>(std::vector<py::ssize_t>{count, 3})};
        double* const lower_m = answers.lower_m.mutable_data();
        double* const upper_m = answers.upper_m.mutable_data();
        std::uint8_t* const side = answers.side.mutable_data();
        double* const nearest_m = answers.nearest_m.mutable_data();
        check_unlocked(
            [&](tactus_error* error)
            {
                return tactus_static_model_distances(model_, static_cast<std::size_t>(count),
                                                     points.data(), lower_m, upper_m, side,
                                                     nearest_m, error);
            });
        return answers;
    }

private:
    tactus_static_model* model_{nullptr};
};

std::array<double, 3> to_array(const double (&values)[3])
{
    return {values[0], values[1], values[2]};
}

/// Adds the kinds and flags of answers.
void add_constants(py::module_& module)
{
    module.attr("EXACT") = static_cast<int>(TACTUS_EXACT);
    module.attr("SEPARATED") = static_cast<int>(TACTUS_SEPARATED);
    module.attr("BOUNDED") = static_cast<int>(TACTUS_BOUNDED);
    module.attr("STALE") = static_cast<int>(TACTUS_STALE);
    module.attr("WITHIN_TOLERANCE") = static_cast<int>(TACTUS_WITHIN_TOLERANCE);
    module.attr("IN_CONTACT") = TACTUS_IN_CONTACT;
    module.attr("HALTED") = TACTUS_HALTED;
    module.attr("OVER_CONSTRAINED") = TACTUS_OVER_CONSTRAINED;
    module.attr("CAPACITY_EXCEEDED") = TACTUS_CAPACITY_EXCEEDED;
    module.attr("RATE_LIMITED") = TACTUS_RATE_LIMITED;
    module.attr("DATA_LIMITED") = TACTUS_DATA_LIMITED;
}

/// Adds the class Model.
void add_model(py::module_& module)
{
    using namespace py::literals;
    py::class_<Model, std::shared_ptr<Model>>(module, "Model",
                                              R"(An .spm model, for one Frame at a time.

>>> model = tactus.Model("torus.spm")
>>> model.faces, model.is_closed, len(model.hash)
(5000, True, 32)
)")
        .def(py::init<const std::string&>(), "path"_a,
             "Opens an .spm file; raises Error if the file is refused.")
        .def_static(
            "find",
            [](const std::string& name, std::uint32_t domain, double wait_s)
            { return std::make_shared<Model>(name, domain, wait_s); },
            "name"_a, "domain"_a = 0, "wait_s"_a = 10.0,
            "Finds the model NAME or NAME@HASH on a DDS domain; waits at most wait_s seconds.")
        .def_property_readonly("faces", [](const Model& m) { return m.info().faces; })
        .def_property_readonly("vertices", [](const Model& m) { return m.info().vertices; })
        .def_property_readonly("diagonal_m", [](const Model& m) { return m.info().diagonal_m; })
        .def_property_readonly("low_m", [](const Model& m) { return to_array(m.info().low_m); })
        .def_property_readonly("high_m", [](const Model& m) { return to_array(m.info().high_m); })
        .def_property_readonly("is_closed", [](const Model& m) { return m.info().is_closed != 0; })
        .def_property_readonly("hash", [](const Model& m) { return m.info().hash; });
}

/// Adds the classes StaticModel and Distances, with the sides.
void add_static_model(py::module_& module)
{
    using namespace py::literals;
    module.attr("UNSIGNED") = static_cast<int>(TACTUS_UNSIGNED);
    module.attr("OUTSIDE") = static_cast<int>(TACTUS_OUTSIDE);
    module.attr("INSIDE") = static_cast<int>(TACTUS_INSIDE);
    py::class_<Distances>(module, "Distances",
                          "Distances of N points: arrays of N, nearest_m of N x 3.")
        .def_readonly("lower_m", &Distances::lower_m)
        .def_readonly("upper_m", &Distances::upper_m)
        .def_readonly("side", &Distances::side)
        .def_readonly("nearest_m", &Distances::nearest_m);
    py::class_<StaticModel>(module, "StaticModel", R"(A whole model, refined to its source mesh.

>>> answer = tactus.StaticModel("torus.spm").distances([[0.05, 0, 0], [0, 0, 0]])
>>> [int(side) for side in answer.side] == [tactus.INSIDE, tactus.OUTSIDE]
True
)")
        .def(py::init<const std::string&>(), "path"_a)
        .def("distances", &StaticModel::distances, "points_m"_a,
             "Distances of N x 3 points to the surface; points are in the source mesh's frame.");
}

/// Adds the classes Tool and Object.
void add_tool_and_object(py::module_& module)
{
    using namespace py::literals;
    py::class_<tactus_tool>(module, "Tool", R"(A tool: all points within radius_m of its core.
The radius is 1e-6 to 1 m, up to 1000 m for a query-only tool (query_only).

>>> sphere = tactus.Tool(0.002, stiffness_n_per_m=800)
>>> pen = tactus.Tool(0.001, shape="capsule", half_m=[0, 0, 0.04])
)")
        .def(py::init(&make_tool), "radius_m"_a, py::kw_only(), "shape"_a = "sphere",
             "half_m"_a = py::none(), "query_only"_a = false, "wants_distance"_a = false,
             "stiffness_n_per_m"_a = py::none(), "force_max_n"_a = py::none(),
             "torque_max_nm"_a = py::none(), "speed_max_m_per_s"_a = py::none(),
             "shading_m"_a = 0.0);

    py::class_<tactus_object>(module, "Object", R"(A model with a pose in the world.
Scale 0.001 to 1000, translation within 10,000 m; friction 0 to 3, dynamic at most static.

>>> cup = tactus.Object(translation_m=[0.1, 0, 0], static_friction=0.4, dynamic_friction=0.3)
)")
        .def(py::init(&make_object), "model"_a = 0, py::kw_only(), "rotation"_a = py::none(),
             "translation_m"_a = py::none(), "scale"_a = 1.0, "static_friction"_a = 0.0,
             "dynamic_friction"_a = 0.0);
}

/// Adds the classes Frame and Answers.
void add_frame(py::module_& module)
{
    using namespace py::literals;
    py::class_<Answers>(module, "Answers",
                        "Answers of a run: arrays over N poses, T tools and J objects.")
        .def_readonly("force_n", &Answers::force_n)
        .def_readonly("torque_nm", &Answers::torque_nm)
        .def_readonly("proxy_m", &Answers::proxy_m)
        .def_readonly("flags", &Answers::flags)
        .def_readonly("lower_m", &Answers::lower_m)
        .def_readonly("upper_m", &Answers::upper_m)
        .def_readonly("kind", &Answers::kind)
        .def_readonly("nearest_m", &Answers::nearest_m);

    py::class_<Frame>(module, "Frame", R"(Tools and objects, in memory of a fixed size.

>>> frame = tactus.Frame([tactus.Model("torus.spm")], [tactus.Tool(0.002)], [tactus.Object()],
...                      memory_mib=32, loads_whole=True)
>>> while not frame.state()["is_whole"]:
...     frame.load()
...     answers = frame.run([[0.05, 0, 0.03]])
>>> answers = frame.run([[0.05, 0, 0.03 - 1e-5 * i] for i in range(900)])
>>> bool(answers.flags[-1] & tactus.IN_CONTACT), float(answers.force_n[-1, 2]) > 0
(True, True)
)")
        .def(py::init<std::vector<std::shared_ptr<Model>>, const std::vector<tactus_tool>&,
                      const std::vector<tactus_object>&, double, double, bool, double>(),
             "models"_a, "tools"_a, "objects"_a, py::kw_only(), "memory_mib"_a = 16.0,
             "period_s"_a = 1e-3, "loads_whole"_a = false, "object_speed_max_m_per_s"_a = 0.5)
        .def("run", &Frame::run, "positions_m"_a, "rotations"_a = py::none(), "rounds"_a = 0,
             "Moves the tools through N poses, one frame each. With `rounds`, each pose has up to "
             "that many frames, with loading in between, until all answers are exact, within "
             "tolerance or separated.")
        .def("load", &Frame::load, "Runs one round of loading.")
        .def("place", &Frame::place, "object"_a, py::kw_only(), "rotation"_a = py::none(),
             "translation_m"_a = py::none(), "scale"_a = 1.0,
             "Sets the pose of an object from the next frame on.")
        .def(
            "feel", &Frame::feel, "object"_a, py::kw_only(), "stiffness_n_per_m"_a = 0.0,
            "static_friction"_a = 0.0, "dynamic_friction"_a = 0.0, "damping_n_s_per_m"_a = 0.0,
            "viscosity_n_s_per_m"_a = 0.0, "texture_height_m"_a = 0.0, "texture_length_m"_a = 0.0,
            "Sets the material of an object from the next frame on; contacts blend to it in 50 ms.")
        .def("state", &Frame::state);
}

} // namespace

PYBIND11_MODULE(tactus, module)
{
    module.doc() =
        R"(Distances and forces between tools and triangle meshes, exact or with proven bounds.
Units are SI; see docs/python.md.

>>> import tactus
>>> model = tactus.Model("torus.spm")
>>> probe = tactus.Tool(0.02, query_only=True)
>>> frame = tactus.Frame([model], [probe], [tactus.Object()])
>>> answers = frame.run([[0.05, 0, 0.03], [0, 0, 0.2]], rounds=1000)
>>> [int(kind) for kind in answers.kind[:, 0]] == [tactus.EXACT, tactus.SEPARATED]
True
>>> round(float(answers.lower_m[0, 0]), 3)
0.01
)";
    if (tactus_abi() != TACTUS_ABI)
    {
        throw py::import_error("the module was made for another version of libtactus");
    }
    module.attr("__version__") = tactus_version();
    py::register_exception<TactusError>(module, "Error", PyExc_RuntimeError);

    add_constants(module);
    add_model(module);
    add_static_model(module);
    add_tool_and_object(module);
    add_frame(module);
    add_world(module);
}
