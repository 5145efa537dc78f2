// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <string>

namespace tactus
{

/// Functions of Force Dimension's SDK (3.x), by their public C names. They are declared from its
/// documentation, so a build needs none of its files. An int result is negative on failure, 0 or
/// positive on success. `id` is the result of dhdOpenID(). One thread at a time; calls wait for the
/// device's bus. All values are in the device's coordinates.
struct DhdFunctions
{
    int (*dhdGetDeviceCount)();
    int (*dhdOpenID)(char index);
    int (*dhdClose)(char id);
    const char* (*dhdGetSystemName)(char id); ///< Null if unknown.
    int (*dhdGetPosition)(double* x_m, double* y_m, double* z_m, char id);
    int (*dhdGetLinearVelocity)(double* x_m_per_s, double* y_m_per_s, double* z_m_per_s, char id);
    /// Rows of the rotation; the identity if the device has no wrist.
    int (*dhdGetOrientationFrame)(double matrix[3][3], char id);
    int (*dhdGetAngularVelocityRad)(double* x_rad_per_s, double* y_rad_per_s, double* z_rad_per_s,
                                    char id);
    int (*dhdGetGripperGap)(double* gap_m, char id);
    bool (*dhdHasWrist)(char id);
    bool (*dhdHasActiveWrist)(char id);
    bool (*dhdHasGripper)(char id);
    bool (*dhdHasActiveGripper)(char id);
    int (*dhdGetButton)(int index, char id); ///< 1 while the button is pressed.
    unsigned (*dhdGetButtonMask)(char id);   ///< Bit n is set while button n is pressed.
    /// Torque and gripper force are ignored if the device makes none.
    int (*dhdSetForceAndTorqueAndGripperForce)(double fx_n, double fy_n, double fz_n, double tx_nm,
                                               double ty_nm, double tz_nm, double grip_n, char id);
    int (*dhdSetBrakes)(int on, char id);
    int (*dhdEnableForce)(unsigned char on, char id);
    const char* (*dhdErrorGetLastStr)(); ///< Text of the last failure.
    /// Null in SDKs before 3.3.2. Sets the time without a force, in steps of 125 us, after which
    /// the device itself disables its forces, even if the program is dead; 0: never.
    int (*dhdSetWatchdog)(unsigned char steps, char id);
};

/// The SDK, loaded on request and unloaded at the end of its life.
class DhdLibrary
{
public:
    /// Loads a library. `path` is a file, or a name for the system's loader; empty: the names under
    /// which the SDK is installed. A library that is missing or lacks a function is refused in one
    /// line.
    [[nodiscard]] static Result<DhdLibrary, Refusal> load(const std::string& path);

    DhdLibrary(DhdLibrary&& other) noexcept;
    DhdLibrary& operator=(DhdLibrary&&) = delete;
    ~DhdLibrary();

    [[nodiscard]] const DhdFunctions& operator*() const noexcept { return functions_; }
    [[nodiscard]] const DhdFunctions* operator->() const noexcept { return &functions_; }

private:
    explicit DhdLibrary(void* handle) noexcept : handle_(handle) {}

    /// Null, or the name of a function that the library lacks.
    [[nodiscard]] const char* find_functions() noexcept;

    void* handle_;
    DhdFunctions functions_{};
};

} // namespace tactus
