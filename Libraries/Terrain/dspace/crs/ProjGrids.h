// PROJ's grids of datum shifts, as files that a recording needs. Not for public headers.
#ifndef DSPACE_TERRAIN_PROJGRIDS_H
#define DSPACE_TERRAIN_PROJGRIDS_H

class OGRSpatialReference;

namespace dspace {

// Notes (NoteSystemFile) every grid that a conversion between the two may use, wherever on the map:
// PROJ chooses by place. Those that it knows of and that are not installed are noted as absent
// files of its data folder, since with them the result would be another one. Nothing where both
// have one datum.
void NoteGrids(const OGRSpatialReference& from, const OGRSpatialReference& to);

} // namespace dspace

#endif
