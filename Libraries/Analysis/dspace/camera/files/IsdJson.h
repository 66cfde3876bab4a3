// USGS image support data: internal, not installed.
#ifndef DSPACE_CAMERA_FILES_ISD_JSON_H
#define DSPACE_CAMERA_FILES_ISD_JSON_H

#include <string>

#include <dspace/camera/CameraModel.h>

namespace dspace {

// Whether JSON text has what every ISD has: "name_model" and "focal2pixel_lines".
bool IsIsdJson(const std::string& text);

// The camera of an ISD as ALE writes it (USGS, Abstraction Library for Ephemerides): of
// USGS_ASTRO_FRAME_SENSOR_MODEL the type usgs, of USGS_ASTRO_LINE_SCANNER_SENSOR_MODEL the type
// line_scan. The model's frame M is the body's fixed axes; Z is along the boresight. An ISD's pixel
// (0.5, 0.5), line and sample, is the centre of the first. Light time and aberration are left out.
//
// Throws Error(Corrupt) for damaged text, Error(Unsupported) for other sensors, distortions other
// than radial ones, and line scanners whose rate changes; Error(InvalidArgument) for numbers that
// are no camera.
CameraModel ParseIsdJson(const std::string& text, const std::string& label);

} // namespace dspace

#endif
