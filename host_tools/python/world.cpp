// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/python/arrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

namespace tactus_python
{

namespace
{

/// Owner of a world; handles keep it alive.
using Owner = std::shared_ptr<tactus_world>;

/// Three numbers.
Numbers vector_of(const py::object& given, const char* name)
{
    Numbers vector = numbers_of(given, name);
    check_shape(vector, {3}, name);
    return vector;
}

/// Nine numbers of an optional rotation; null for None.
const double* rotation_of(const py::object& rotation, Numbers& rows)
{
    if (rotation.is_none())
    {
        return nullptr;
    }
    rows = numbers_of(rotation, "rotation");
    check_shape(rows, {3, 3}, "rotation");
    return rows.data();
}

/// Text of a string or a path.
std::string text_of(const py::object& given)
{
    const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(given.ptr()));
    if (!path)
    {
        throw py::error_already_set();
    }
    return py::cast<std::string>(path);
}

/// Faces, M x 3, as indices.
py::array_t<std::uint32_t> faces_of(const py::object& given)
{
    const Numbers corners = numbers_of(given, "faces");
    const py::ssize_t count = corners.ndim() > 0 ? corners.shape(0) : 0;
    check_shape(corners, {count, 3}, "faces");
    py::array_t<std::uint32_t> faces(std::vector<py::ssize_t>{count, 3});
    std::uint32_t* const written = faces.mutable_data();
    for (py::ssize_t i = 0; i < 3 * count; ++i)
    {
        const double index = corners.data()[i];
        const bool is_index = index >= 0.0 && std::floor(index) == index &&
                              index <= std::numeric_limits<std::uint32_t>::max();
        if (!is_index) // NaN, too.
        {
            throw py::value_error("faces: element " + std::to_string(i) + " is " +
                                  std::string(py::str(py::float_(index))) +
                                  "; a whole number from 0 is needed");
        }
        written[i] = static_cast<std::uint32_t>(index);
    }
    return faces;
}

class WorldObject
{
public:
    WorldObject(Owner world, tactus_handle handle) : world_(std::move(world)), handle_(handle) {}

    void move(const py::object& rotation, const py::object& translation_m, double scale) const
    {
        tactus_world_object place;
        tactus_world_object_default(&place);
        read_pose(place.pose, rotation, translation_m, scale);
        check([&](tactus_error* error)
              { return tactus_world_move(world_.get(), handle_, &place.pose, error); });
    }
    void feel(const tactus_material& material) const
    {
        check([&](tactus_error* error)
              { return tactus_world_feel(world_.get(), handle_, &material, error); });
    }
    void remove() const
    {
        check([&](tactus_error* error)
              { return tactus_world_remove(world_.get(), handle_, error); });
    }
    template <auto edit>
    [[nodiscard]] double edit_by_sweep(const std::string& tool, const py::object& position_m,
                                       const py::object& to_m, const py::object& rotation) const
    {
        Numbers rows;
        const double* const turned = rotation_of(rotation, rows);
        const Numbers from = vector_of(position_m, "position_m");
        const Numbers to = vector_of(to_m, "to_m");
        double volume_m3 = 0.0;
        check_unlocked(
            [&](tactus_error* error)
            {
                return edit(world_.get(), handle_, tool.c_str(), from.data(), turned, to.data(),
                            &volume_m3, error);
            });
        return volume_m3;
    }
    [[nodiscard]] double displace(const py::object& center_m, double radius_m,
                                  const py::object& vector_m) const
    {
        const Numbers center = vector_of(center_m, "center_m");
        const Numbers vector = vector_of(vector_m, "vector_m");
        double volume_m3 = 0.0;
        check_unlocked(
            [&](tactus_error* error)
            {
                return tactus_world_displace(world_.get(), handle_, center.data(), radius_m,
                                             vector.data(), &volume_m3, error);
            });
        return volume_m3;
    }
    void save(const py::object& path) const
    {
        const std::string text = text_of(path);
        check_unlocked([&](tactus_error* error)
                       { return tactus_world_save(world_.get(), handle_, text.c_str(), error); });
    }

private:
    Owner world_;
    tactus_handle handle_;
};

/// Answers of a path of N poses.
struct Felt
{
    py::array_t<double> force_n;
    py::array_t<double> torque_nm;
    py::array_t<double> proxy_m;
    py::array_t<bool> in_contact;
    py::array_t<std::int32_t> withheld;
};

class Hand
{
public:
    Hand(Owner world, tactus_handle handle) : world_(std::move(world)), handle_(handle) {}

    [[nodiscard]] tactus_hand_state state() const
    {
        tactus_hand_state state{};
        state.size = sizeof(state);
        check([&](tactus_error* error)
              { return tactus_world_state(world_.get(), handle_, &state, error); });
        return state;
    }
    [[nodiscard]] tactus_hand_state step(const py::object& position_m, const py::object& rotation,
                                         double dt_s) const
    {
        Numbers rows;
        const double* const turned = rotation_of(rotation, rows);
        const Numbers place = vector_of(position_m, "position_m");
        tactus_hand_state state{};
        state.size = sizeof(state);
        check_unlocked(
            [&](tactus_error* error) {
                return tactus_world_step(world_.get(), handle_, place.data(), turned, dt_s, &state,
                                         error);
            });
        return state;
    }
    void hold(const py::object& position_m, const py::object& rotation) const
    {
        Numbers rows;
        const double* const turned = rotation_of(rotation, rows);
        const Numbers place = vector_of(position_m, "position_m");
        check([&](tactus_error* error)
              { return tactus_world_hold(world_.get(), handle_, place.data(), turned, error); });
    }
    /// Runs one frame for each of N positions.
    [[nodiscard]] Felt path(const py::object& positions_m, const py::object& rotations) const
    {
        const Numbers positions = numbers_of(positions_m, "positions_m");
        const py::ssize_t count = positions.ndim() > 0 ? positions.shape(0) : 0;
        check_shape(positions, {count, 3}, "positions_m");
        Numbers turned;
        if (!rotations.is_none())
        {
            turned = numbers_of(rotations, "rotations");
            check_shape(turned, {count, 3, 3}, "rotations");
        }
        const std::vector<py::ssize_t> vectors{count, 3};
        Felt felt{py::array_t<double>(vectors), py::array_t<double>(vectors),
                  py::array_t<double>(vectors), py::array_t<bool>(count),
                  py::array_t<std::int32_t>(count)};
        double* const force_n = felt.force_n.mutable_data();
        double* const torque_nm = felt.torque_nm.mutable_data();
        double* const proxy_m = felt.proxy_m.mutable_data();
        bool* const in_contact = felt.in_contact.mutable_data();
        std::int32_t* const withheld = felt.withheld.mutable_data();
        const double* const places = positions.data();
        const double* const rows = rotations.is_none() ? nullptr : turned.data();
        check_unlocked(
            [&](tactus_error* error)
            {
                tactus_result result = TACTUS_DONE;
                for (py::ssize_t i = 0; i < count && result == TACTUS_DONE; ++i)
                {
                    tactus_hand_state state{};
                    state.size = sizeof(state);
                    result = tactus_world_step(world_.get(), handle_, places + 3 * i,
                                               rows != nullptr ? rows + 9 * i : nullptr, 0.0,
                                               &state, error);
                    std::copy_n(state.force_n, 3, force_n + 3 * i);
                    std::copy_n(state.torque_nm, 3, torque_nm + 3 * i);
                    std::copy_n(state.proxy_m, 3, proxy_m + 3 * i);
                    in_contact[i] = state.in_contact != 0;
                    withheld[i] = state.withheld;
                }
                return result;
            });
        return felt;
    }

private:
    Owner world_;
    tactus_handle handle_;
};

class World
{
public:
    World(std::int64_t rate_hz, double memory_mib, double stiffness_n_per_m,
          std::uint32_t objects_max, double object_speed_m_per_s, double wait_s, double duration_s,
          std::uint32_t domain, bool is_watched, bool allow_no_rt, const std::string& record,
          bool follows_poses, bool loads_whole, bool has_no_guardian)
    {
        tactus_world_options options;
        tactus_world_options_default(&options);
        options.rate_hz = rate_hz;
        options.memory_mib = memory_mib;
        options.stiffness_n_per_m = stiffness_n_per_m;
        options.objects_max = objects_max;
        options.object_speed_m_per_s = object_speed_m_per_s;
        options.wait_s = wait_s;
        options.duration_s = duration_s;
        options.domain = domain;
        options.is_watched = is_watched ? 1 : 0;
        options.allow_no_rt = allow_no_rt ? 1 : 0;
        options.record = record.c_str();
        options.follows_poses = follows_poses ? 1 : 0;
        options.loads_whole = loads_whole ? 1 : 0;
        options.has_no_guardian = has_no_guardian ? 1 : 0;
        tactus_world* world = nullptr;
        check([&](tactus_error* error) { return tactus_world_make(&options, &world, error); });
        world_ = Owner(world,
                       [](tactus_world* ended)
                       {
                           const py::gil_scoped_release others_may_run;
                           tactus_world_end(ended);
                       });
    }

    WorldObject add(const py::object& model, const std::string& unit, bool published,
                    const py::object& rotation, const py::object& translation_m, double scale,
                    const tactus_material& material, std::uint32_t edit_faces) const
    {
        tactus_world_object object;
        tactus_world_object_default(&object);
        read_pose(object.pose, rotation, translation_m, scale);
        object.unit = unit.c_str();
        object.material = &material;
        object.edit_faces = edit_faces;
        std::string text = "mesh";
        Numbers vertices;
        py::array_t<std::uint32_t> faces;
        if (py::hasattr(model, "__fspath__") || py::isinstance<py::str>(model))
        {
            text = text_of(model);
            const bool is_model = text.size() >= 4 && text.ends_with(".spm");
            object.source = published  ? TACTUS_PUBLISHED
                            : is_model ? TACTUS_MODEL_FILE
                                       : TACTUS_MESH_FILE;
        }
        else
        {
            if (!py::isinstance<py::sequence>(model) || py::len(model) != 2)
            {
                throw py::type_error("model: " + std::string(py::str(py::type::of(model))) +
                                     "; a path, or a pair of vertices and faces, is needed");
            }
            const auto parts = py::cast<std::pair<py::object, py::object>>(model);
            vertices = numbers_of(parts.first, "vertices");
            check_shape(vertices, {vertices.ndim() > 0 ? vertices.shape(0) : 0, 3}, "vertices");
            faces = faces_of(parts.second);
            object.source = TACTUS_MESH;
            object.vertices = vertices.data();
            object.vertex_count = static_cast<std::uint32_t>(vertices.shape(0));
            object.faces = faces.data();
            object.face_count = static_cast<std::size_t>(faces.shape(0));
        }
        object.text = text.c_str();
        tactus_handle handle = 0;
        check_unlocked([&](tactus_error* error)
                       { return tactus_world_add(world_.get(), &object, &handle, error); });
        return {world_, handle};
    }
    Hand hand(const std::string& tool, const std::optional<std::string>& device,
              const std::optional<std::string>& edit) const
    {
        tactus_handle handle = 0;
        check(
            [&](tactus_error* error)
            {
                return tactus_world_add_hand(world_.get(), tool.c_str(),
                                             device ? device->c_str() : nullptr,
                                             edit ? edit->c_str() : nullptr, &handle, error);
            });
        return {world_, handle};
    }
    void start() const
    {
        check_unlocked([&](tactus_error* error)
                       { return tactus_world_start(world_.get(), error); });
    }
    void stop() const
    {
        check_unlocked([&](tactus_error* error) { return tactus_world_stop(world_.get(), error); });
    }
    void step(double dt_s) const
    {
        check_unlocked(
            [&](tactus_error* error)
            { return tactus_world_step(world_.get(), 0, nullptr, nullptr, dt_s, nullptr, error); });
    }
    [[nodiscard]] py::dict counts() const
    {
        tactus_world_counts counts{};
        counts.size = sizeof(counts);
        check([&](tactus_error* error)
              { return tactus_world_counts_of(world_.get(), &counts, error); });
        using namespace py::literals;
        return py::dict("frames"_a = counts.frames, "missed"_a = counts.missed,
                        "overruns"_a = counts.overruns, "latency_misses"_a = counts.latency_misses,
                        "brakes"_a = counts.brakes, "is_running"_a = counts.is_running != 0);
    }

private:
    Owner world_;
};

Felt touch(const py::object& model, const py::object& positions_m, const std::string& tool,
           const std::string& unit, double memory_mib, double stiffness_n_per_m)
{
    const World world(1'000, memory_mib, stiffness_n_per_m, 0, 0.5, 10.0, 0.0, 0, false, false, "",
                      true, true, false);
    static_cast<void>(world.add(model, unit, false, py::none(), py::none(), 1.0,
                                material_of(0.0, 0.0, std::nullopt, 0.0, 0.0, 0.0, 0.0), 0));
    return world.hand(tool, std::nullopt, std::nullopt).path(positions_m, py::none());
}

std::array<double, 3> three(const double (&values)[3])
{
    return {values[0], values[1], values[2]};
}

/// Adds the classes HandState and Felt.
void add_answers(py::module_& module)
{
    py::class_<tactus_hand_state>(module, "HandState", "State of a hand after a frame.")
        .def_property_readonly("frame", [](const tactus_hand_state& s) { return s.frame; })
        .def_property_readonly("force_n",
                               [](const tactus_hand_state& s) { return three(s.force_n); })
        .def_property_readonly("torque_nm",
                               [](const tactus_hand_state& s) { return three(s.torque_nm); })
        .def_property_readonly("position_m",
                               [](const tactus_hand_state& s) { return three(s.position_m); })
        .def_property_readonly("proxy_m",
                               [](const tactus_hand_state& s) { return three(s.proxy_m); })
        .def_property_readonly("in_contact",
                               [](const tactus_hand_state& s) { return s.in_contact != 0; })
        .def_property_readonly("began_inside",
                               [](const tactus_hand_state& s) { return s.began_inside != 0; })
        .def_property_readonly("withheld", [](const tactus_hand_state& s) { return s.withheld; })
        .def_property_readonly("why",
                               [](const tactus_hand_state& s) { return std::string(s.why); });
    py::class_<Felt>(
        module, "Felt",
        "Answers of a path of N poses: force_n, torque_nm, proxy_m (N x 3), in_contact "
        "and withheld (N).")
        .def_readonly("force_n", &Felt::force_n)
        .def_readonly("torque_nm", &Felt::torque_nm)
        .def_readonly("proxy_m", &Felt::proxy_m)
        .def_readonly("in_contact", &Felt::in_contact)
        .def_readonly("withheld", &Felt::withheld);
}

/// Adds the classes WorldObject and Hand.
void add_handles(py::module_& module)
{
    using namespace py::literals;
    py::class_<WorldObject>(module, "WorldObject", "Handle of an object of a World.")
        .def("move", &WorldObject::move, py::kw_only(), "rotation"_a = py::none(),
             "translation_m"_a = py::none(), "scale"_a = 1.0, "Moves the object to a pose.")
        .def(
            "feel",
            [](const WorldObject& object, double stiffness_n_per_m, double static_friction,
               const std::optional<double>& dynamic_friction, double damping_n_s_per_m,
               double viscosity_n_s_per_m, double texture_height_m, double texture_length_m)
            {
                object.feel(material_of(stiffness_n_per_m, static_friction, dynamic_friction,
                                        damping_n_s_per_m, viscosity_n_s_per_m, texture_height_m,
                                        texture_length_m));
            },
            py::kw_only(), "stiffness_n_per_m"_a = 0.0, "static_friction"_a = 0.0,
            "dynamic_friction"_a = py::none(), "damping_n_s_per_m"_a = 0.0,
            "viscosity_n_s_per_m"_a = 0.0, "texture_height_m"_a = 0.0, "texture_length_m"_a = 0.0,
            "Gives the object another material; a stiffness of 0 is the tool's.")
        .def("remove", &WorldObject::remove, "Removes the object.")
        .def("carve", &WorldObject::edit_by_sweep<&tactus_world_carve>, "tool"_a, "position_m"_a,
             "to_m"_a, "rotation"_a = py::none(),
             "Removes from the model what a tool sweeps, in the model's frame; returns the volume.")
        .def("fill", &WorldObject::edit_by_sweep<&tactus_world_fill>, "tool"_a, "position_m"_a,
             "to_m"_a, "rotation"_a = py::none(),
             "Adds to the model what a tool sweeps; returns the volume.")
        .def("displace", &WorldObject::displace, "center_m"_a, "radius_m"_a, "vector_m"_a,
             "Moves vertices of the model round a place; returns the added volume.")
        .def("save", &WorldObject::save, "path"_a,
             "Writes the model with its edits as one .spm file.");
    py::class_<Hand>(module, "Hand", "Handle of a tool and its device.")
        .def("step", &Hand::step, "position_m"_a, "rotation"_a = py::none(), "dt_s"_a = 0.0,
             "Moves the hand and runs the next frame.")
        .def("path", &Hand::path, "positions_m"_a, "rotations"_a = py::none(),
             "Runs one frame for each of N positions, N x 3, and rotations, N x 3 x 3.")
        .def("hold", &Hand::hold, "position_m"_a, "rotation"_a = py::none(),
             "Moves the hand for the next frames.")
        .def("state", &Hand::state, "State after the newest frame; never waits for the loop.");
}

/// Adds the class World.
void add_world_class(py::module_& module)
{
    using namespace py::literals;
    py::class_<World>(module, "World", R"(Objects, hands and the guarded loop of hrtc.
Options are those of hrtc; see docs/python.md.

>>> world = tactus.World(memory_mib=8)
>>> torus = world.add("torus.spm")
>>> hand = world.hand("sphere:0.002")
>>> for i in range(1000):
...     state = hand.step([0.05, 0, max(0.0315 - 2e-5 * i, 0.0215)])
>>> state.in_contact, round(state.force_n[2], 2), state.why
(True, 0.19, '')
)")
        .def(py::init<std::int64_t, double, double, std::uint32_t, double, double, double,
                      std::uint32_t, bool, bool, const std::string&, bool, bool, bool>(),
             py::kw_only(), "rate_hz"_a = 1'000, "memory_mib"_a = 2.0,
             "stiffness_n_per_m"_a = 500.0, "objects_max"_a = 0, "object_speed_m_per_s"_a = 0.5,
             "wait_s"_a = 10.0, "duration_s"_a = 0.0, "domain"_a = 0, "is_watched"_a = false,
             "allow_no_rt"_a = false, "record"_a = "", "follows_poses"_a = true,
             "loads_whole"_a = true, "has_no_guardian"_a = false)
        .def(
            "add",
            [](const World& world, const py::object& model, const std::string& unit, bool published,
               const py::object& rotation, const py::object& translation_m, double scale,
               double stiffness_n_per_m, double static_friction,
               const std::optional<double>& dynamic_friction, double damping_n_s_per_m,
               double viscosity_n_s_per_m, std::uint32_t edit_faces)
            {
                return world.add(model, unit, published, rotation, translation_m, scale,
                                 material_of(stiffness_n_per_m, static_friction, dynamic_friction,
                                             damping_n_s_per_m, viscosity_n_s_per_m, 0.0, 0.0),
                                 edit_faces);
            },
            "model"_a, py::kw_only(), "unit"_a = "m", "published"_a = false,
            "rotation"_a = py::none(), "translation_m"_a = py::none(), "scale"_a = 1.0,
            "stiffness_n_per_m"_a = 0.0, "static_friction"_a = 0.0,
            "dynamic_friction"_a = py::none(), "damping_n_s_per_m"_a = 0.0,
            "viscosity_n_s_per_m"_a = 0.0, "edit_faces"_a = 0,
            "Adds an object: the path of an .spm file or of a mesh, the name of a published model, "
            "or a pair of vertices, N x 3, and faces, M x 3. edit_faces is the model's room for "
            "faces that edits add.")
        .def("hand", &World::hand, "tool"_a = "sphere:0.002", "device"_a = py::none(),
             "edit"_a = py::none(),
             "Adds a tool and its device in the words of hrtc; without a device the program moves "
             "the hand. With edit=\"carve:RATE\" the tool carves what it presses on.")
        .def("start", &World::start, "Starts the guarded loop.")
        .def("stop", &World::stop, "Ends the loop once the forces have faded.")
        .def("step", &World::step, "dt_s"_a = 0.0, "Runs the next frame, with all hands in place.")
        .def("counts", &World::counts, "Counts since the start.");
}

/// Adds the function touch().
void add_touch(py::module_& module)
{
    using namespace py::literals;
    module.def("touch", &touch, R"(Forces of a sphere or another tool on its path over a model.

>>> import numpy
>>> path = numpy.linspace([0.05, 0, 0.0315], [0.05, 0, 0.0215], 500)
>>> bool(tactus.touch("torus.spm", path).in_contact[-1])
True
)",
               "model"_a, "positions_m"_a, py::kw_only(), "tool"_a = "sphere:0.002", "unit"_a = "m",
               "memory_mib"_a = 2.0, "stiffness_n_per_m"_a = 500.0);
}

} // namespace

void add_world(py::module_& module)
{
    add_answers(module);
    add_handles(module);
    add_world_class(module);
    add_touch(module);
}

} // namespace tactus_python
