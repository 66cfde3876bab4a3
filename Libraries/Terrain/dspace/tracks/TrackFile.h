// Wheel tracks as a file of lines.
#ifndef DSPACE_TERRAIN_TRACKFILE_H
#define DSPACE_TERRAIN_TRACKFILE_H

#include <functional>
#include <string>
#include <vector>

#include <dspace/crs/Crs.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {

// GeoJSON, written and read by GDAL: one feature a stroke, in the order in which they were begun.
// Its geometry is a LineString of the contacts in map coordinates of the terrain's CRS (a lone
// contact is there twice). Its properties: "wheel"; "width", "wall", "rim_width", "rim_height",
// "tread_pitch", "tread_depth" [m]; and of each contact "sinkage" [m], "rolled" [m] and
// "heading_deg" (counter-clockwise from the terrain's X axis; absent where all follow the path, and
// the path's for a contact that does among others that do not); and "crs", the terrain's as WKT (""
// without one). Throws Error(Io); the file is then as it was.
void WriteTracks(const std::string& path, const std::vector<TrackStroke>& strokes, const Crs& crs,
                 const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& sceneToMap);

// As additions that begin strokes and keep all contacts. Files of other programs do with "sinkage",
// a number or a list; what else is absent is as TrackProfile and TrackContact have it. Throws
// Error(NotFound), Error(Corrupt) for what is no such file, and InvalidArgument for a file that
// says another CRS than the terrain's.
std::vector<TrackAddition>
ReadTracks(const std::string& path, const Crs& crs,
           const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& mapToScene);

} // namespace dspace

#endif
