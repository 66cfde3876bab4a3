"""Documents that lead GDAL to another file or to a server, a function for each driver that can refer to one.

A row is a generator of Documents. Add one by writing a function with @row that yields them: `make` gives it a folder of
its own inside the allowed one, and the name of a file outside it, or a URL, that the document refers to.
"""
import base64
import os
import struct
import typing
import zlib

from terrain_support import gdal

SIZE = 8
GRID = f"ncols {SIZE}\nnrows {SIZE}\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + ("1 " * SIZE + "\n") * SIZE
LINE = ('{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"a":1},"geometry":{"type":"LineString",'
        '"coordinates":[[0,0],[3,3]]}}]}')

# Of 1,648 bytes, made with libhdf5 (H5Pset_external): 4 x 4 floats whose bytes are in another file, named by "/" and
# 199 times "n".
HDF5 = ("eNrr9HBx4+WS4mIAAQ4OBhYGAQZk8B8KCthQ+TD5BCjNCKU7oPQKJpg4I1hOAiouCDUfXV1IkKsrSPV/NACzR4MVQnMwjIKRCDxcHQNAdASUD0ul"
        "J5hQ1WWkZqZnlBTD06MHhfYyMrBDzGKE8TUgNBNEgAWqDhfNDEz5IJWCCvJQMQUGcQ4G8XqoPCswRYPkmZggBrIDzWeEWgfKOQYs2NO9AwNMHJKz"
        "mBlhOcYBRZ0QVCfIvFhB5mwGBguqxMMNtHwfwIKqTj9veACYf4L9/F1A8QGLBwXm0TxJDgAAfX2RNQ==")


class Document(typing.NamedTuple):
    name: str    # also of the file outside that it refers to, or in the URL
    path: str
    shapes: bool # opened as shapes, not as a raster


class Maker:
    """Makes the documents of a run below two folders."""

    def __init__(self, inside, outside, url):
        self.inside, self.outside, self.url = inside, outside, url
        inside.mkdir(exist_ok=True)
        outside.mkdir(exist_ok=True)
        self._tiff = self._secret = None
        self.documents = []

    def tiff(self):
        """The bytes of a GeoTIFF."""
        if self._tiff is None:
            data = gdal.GetDriverByName("GTiff").Create("/vsimem/own.tif", SIZE, SIZE, 1, gdal.GDT_Byte)
            data.SetGeoTransform((0, 1, 0, SIZE, 0, -1))
            data.GetRasterBand(1).Fill(3)
            data = None
            self._tiff = content_of("/vsimem/own.tif")
        return self._tiff

    def target(self, name, content=None):
        """The path of a file outside, which holds a raster unless the content is given."""
        path = self.outside / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(self.tiff() if content is None else content)
        return str(path)

    def up(self, name, content=None):
        """The path of a file outside, from the folder of the document of that name."""
        return os.path.relpath(self.target(name, content), self.inside / name)

    def add(self, name, file, content, shapes=False, **others):
        """A document `file` in a folder of its own, with other files beside it."""
        folder = self.inside / name
        folder.mkdir()
        for each, data in {file: content, **others}.items():
            (folder / each.replace("__", ".")).write_bytes(data if isinstance(data, bytes) else data.encode())
        self.documents.append(Document(name, str(folder / file), shapes))


def content_of(name):
    """The bytes of a file of GDAL's memory."""
    file = gdal.VSIFOpenL(name, "rb")
    data = bytes(gdal.VSIFReadL(1, 1 << 16, file))
    gdal.VSIFCloseL(file)
    return data


ROWS = []


def row(function):
    ROWS.append(function)
    return function


def make(inside, outside, url):
    """All documents, below two folders that exist; those that need a server name `url`."""
    maker = Maker(inside, outside, url)
    for function in ROWS:
        function(maker)
    return maker.documents


# --- Mosaics ----------------------------------------------------------------------------------------

def vrt(inner, attributes="", band='<VRTRasterBand dataType="Byte" band="1">'):
    return (f'<VRTDataset rasterXSize="{SIZE}" rasterYSize="{SIZE}"{attributes}><GeoTransform>0, 1, 0, {SIZE}, 0, -1'
            f"</GeoTransform>{band}{inner}{'</VRTRasterBand>' if band else ''}</VRTDataset>")


def source(name, kind="SimpleSource", attributes="", more=""):
    return (f"<{kind}><SourceFilename{attributes}>{name}</SourceFilename><SourceBand>1</SourceBand>"
            f'<SrcRect xOff="0" yOff="0" xSize="{SIZE}" ySize="{SIZE}"/><DstRect xOff="0" yOff="0" xSize="{SIZE}" '
            f'ySize="{SIZE}"/>{more}</{kind}>')


@row
def mosaics_of_each_source(m):
    for kind, more in (("SimpleSource", ""), ("ComplexSource", "<ScaleRatio>2</ScaleRatio>"), ("AveragedSource", ""),
                       ("KernelFilteredSource", '<Kernel normalized="1"><Size>3</Size><Coefs>1 1 1 1 1 1 1 1 1</Coefs></Kernel>')):
        m.add(f"vrt-{kind}", "a.vrt", vrt(source(m.target(f"vrt-{kind}"), kind, more=more)))
        m.add(f"vrt-{kind}-on-server", "a.vrt", vrt(source(f"/vsicurl/{m.url}/vrt-{kind}-on-server.tif", kind, more=more)))


@row
def mosaics_by_name(m):
    """The ways in which a source may be named."""
    def relative(name):
        return os.path.relpath(m.target(name), m.inside / name)

    m.add("vrt-relative", "a.vrt", vrt(source(relative("vrt-relative"), attributes=' relativeToVRT="1"')))
    m.add("vrt-relative-case", "a.vrt", vrt(source(relative("vrt-relative-case"), attributes=' RELATIVETOVRT="1"')))
    m.add("vrt-shared", "a.vrt", vrt(source(m.target("vrt-shared"), attributes=' shared="0"')))
    m.add("vrt-cdata", "a.vrt", vrt(source(f"<![CDATA[{m.target('vrt-cdata')}]]>")))
    m.add("vrt-entities", "a.vrt", vrt(source("".join(f"&#{ord(c)};" for c in m.target("vrt-entities")))))
    m.add("vrt-upper", "a.vrt", vrt(source(m.target("vrt-upper")).replace("SourceFilename", "SOURCEFILENAME")))
    m.add("vrt-subfile", "a.vrt", vrt(source(f"/vsisubfile/0_{len(m.tiff())},{m.target('vrt-subfile')}")))
    sparse = ("<VSISparseFile><SubfileRegion><Filename>{}</Filename><DestinationOffset>0</DestinationOffset><SourceOffset>0"
              "</SourceOffset><RegionLength>{}</RegionLength></SubfileRegion></VSISparseFile>")
    m.add("vrt-sparse", "a.vrt", vrt(source("/vsisparse/" + m.target("vrt-sparse", sparse.format(
        m.target("vrt-sparse.tif"), len(m.tiff())).encode()))))
    m.add("vrt-directory", "a.vrt", vrt(source(f"GTIFF_DIR:1:{m.target('vrt-directory')}")))
    m.add("vrt-raw-tiff", "a.vrt", vrt(source(f"GTIFF_RAW:{m.target('vrt-raw-tiff')}")))
    m.add("vrt-connection", "a.vrt", vrt(source(f"vrt://{m.target('vrt-connection')}?bands=1")))
    m.add("vrt-derived-subdataset", "a.vrt", vrt(source(
        f"DERIVED_SUBDATASET:LOGAMPLITUDE:{m.target('vrt-derived-subdataset')}")))
    m.add("vrt-document", "a.vrt", vrt(source(vrt(source(m.target("vrt-document"))).replace("<", "&lt;"))))
    m.add("vrt-mrf-document", "a.vrt", vrt(source(mrf_text("vrt-mrf-document", m).replace("<", "&lt;"))))
    m.add("vrt-netcdf", "a.vrt", vrt(source(f"NETCDF:{m.target('vrt-netcdf', b'CDF' + bytes(99))}:a")))
    m.add("vrt-of-vrt", "a.vrt", vrt(source("b.vrt", attributes=' relativeToVRT="1"')),
          b__vrt=vrt(source(m.target("vrt-of-vrt"))))


@row
def mosaics_on_servers(m):
    for name, url in (("vsicurl", f"/vsicurl/{m.url}/NAME.tif"), ("vsicurl-option", f"/vsicurl?max_retry=0&amp;url={m.url}/NAME.tif"),
                      ("vsicurl-streaming", f"/vsicurl_streaming/{m.url}/NAME.tif"), ("http", f"{m.url}/NAME.tif"),
                      ("zip-on-server", f"/vsizip/{{/vsicurl/{m.url}/NAME.zip}}/a.tif")):
        m.add(f"vrt-{name}", "a.vrt", vrt(source(url.replace("NAME", f"vrt-{name}"))))
    m.add("vrt-of-vrt-on-server", "a.vrt", vrt(source("b.vrt", attributes=' relativeToVRT="1"')),
          b__vrt=vrt(source(f"/vsicurl/{m.url}/vrt-of-vrt-on-server.tif")))


@row
def mosaics_of_other_sorts(m):
    m.add("vrt-raw-band", "a.vrt", vrt(
        f'<SourceFilename relativetoVRT="0">{m.target("vrt-raw-band")}</SourceFilename><ImageOffset>0</ImageOffset>'
        f"<PixelOffset>1</PixelOffset><LineOffset>{SIZE}</LineOffset>",
        band='<VRTRasterBand dataType="Byte" band="1" subClass="VRTRawRasterBand">'))
    m.add("vrt-derived-band", "a.vrt", vrt(
        "<PixelFunctionType>sum</PixelFunctionType>" + source(m.target("vrt-derived-band")),
        band='<VRTRasterBand dataType="Byte" band="1" subClass="VRTDerivedRasterBand">'))
    m.add("vrt-warped", "a.vrt", vrt(
        f'<VRTRasterBand dataType="Byte" band="1" subClass="VRTWarpedRasterBand"/><BlockXSize>{SIZE}</BlockXSize>'
        f"<BlockYSize>{SIZE}</BlockYSize><GDALWarpOptions><WarpMemoryLimit>6.71089e+07</WarpMemoryLimit>"
        f'<SourceDataset relativeToVRT="0">{m.target("vrt-warped")}</SourceDataset><Transformer><ApproxTransformer>'
        "<MaxError>0.1</MaxError><BaseTransformer><GenImgProjTransformer><SrcGeoTransform>0,1,0,8,0,-1</SrcGeoTransform>"
        "<SrcInvGeoTransform>0,1,0,8,0,-1</SrcInvGeoTransform><DstGeoTransform>0,1,0,8,0,-1</DstGeoTransform>"
        "<DstInvGeoTransform>0,1,0,8,0,-1</DstInvGeoTransform></GenImgProjTransformer></BaseTransformer></ApproxTransformer>"
        '</Transformer><BandList><BandMapping src="1" dst="1"/></BandList></GDALWarpOptions>',
        ' subClass="VRTWarpedDataset"', band=""))
    m.add("vrt-overview", "a.vrt", vrt(
        f'<Overview><SourceFilename relativeToVRT="0">{m.target("vrt-overview")}</SourceFilename><SourceBand>1</SourceBand>'
        "</Overview>" + source("own.tif", attributes=' relativeToVRT="1"')), own__tif=m.tiff())
    m.add("vrt-mask", "a.vrt", vrt(
        source("own.tif", attributes=' relativeToVRT="1"') + '<MaskBand><VRTRasterBand dataType="Byte">'
        + source(m.target("vrt-mask")) + "</VRTRasterBand></MaskBand>"), own__tif=m.tiff())
    m.add("vrt-open-options", "a.vrt", vrt(
        "<SimpleSource><SourceFilename relativeToVRT=\"1\">own.tif</SourceFilename><OpenOptions><OOI key=\"GEOREF_SOURCES\">"
        f'{m.target("vrt-open-options")}</OOI></OpenOptions><SourceBand>1</SourceBand></SimpleSource>'
        + source(m.target("vrt-open-options"))), own__tif=m.tiff())
    m.add("vrt-metadata-overviews", "a.vrt", vrt(
        source("own.tif", attributes=' relativeToVRT="1"')).replace("<GeoTransform>", '<Metadata domain="OVERVIEWS"><MDI '
        f'key="OVERVIEW_FILE">{m.target("vrt-metadata-overviews")}</MDI></Metadata><GeoTransform>'), own__tif=m.tiff())
    m.add("vrt-geolocation", "a.vrt", vrt(source(m.target("vrt-geolocation"))).replace(
        "<GeoTransform>", f'<Metadata domain="GEOLOCATION"><MDI key="X_DATASET">{m.target("vrt-geolocation.x")}</MDI>'
        "</Metadata><GeoTransform>"))


# --- Overviews, masks and other files beside a raster ------------------------------------------------

def carriers(m):
    """(ending, content) of rasters that may have files beside them."""
    yield "tif", m.tiff()
    memory = gdal.GetDriverByName("MEM").Create("", SIZE, SIZE, 1)
    for driver, ending in (("PNG", "png"), ("JPEG", "jpg"), ("BMP", "bmp"), ("GIF", "gif"), ("AAIGrid", "asc"), ("HFA", "img"),
                           ("JP2OpenJPEG", "jp2")):
        name = f"/vsimem/own.{ending}"
        options = {"strict": 0}
        if gdal.GetDriverByName(driver).CreateCopy(name, memory, **options) is None:
            continue
        yield ending, content_of(name)
    yield "pgm", b"P5\n8 8\n255\n" + bytes(64)
    yield "xyz", b"".join(b"%d %d 1\n" % (x, y) for y in range(4) for x in range(4))


def overview_of(name):
    return (f'<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">{name}</MDI></Metadata></PAMDataset>')


@row
def overviews_by_metadata(m):
    """For each format that has a side file, of a file and on a server."""
    for ending, content in carriers(m):
        name = f"overview-{ending}"
        m.add(name, f"a.{ending}", content, **{f"a__{ending}__aux__xml": overview_of(m.target(name))})
        name = f"overview-on-server-{ending}"
        m.add(name, f"a.{ending}", content, **{f"a__{ending}__aux__xml": overview_of(f"/vsicurl/{m.url}/{name}.tif")})


@row
def overviews_that_are_documents(m):
    """Files beside a raster, found by their ending, that are of other formats than one expects."""
    mask = '<Metadata><MDI key="INTERNAL_MASK_FLAGS_1">2</MDI></Metadata><GeoTransform>'
    for ending, content in carriers(m):
        name = f"ovr-mosaic-{ending}"
        m.add(name, f"a.{ending}", content, **{f"a__{ending}__ovr": vrt(source(m.target(name)))})
        name = f"ovr-mosaic-on-server-{ending}"
        m.add(name, f"a.{ending}", content, **{f"a__{ending}__ovr": vrt(source(f"/vsicurl/{m.url}/{name}.tif"))})
        name = f"msk-mosaic-{ending}"
        m.add(name, f"a.{ending}", content,
              **{f"a__{ending}__msk": vrt(source(m.target(name))).replace("<GeoTransform>", mask)})
    m.add("ovr-mrf-tif", "a.tif", m.tiff(), a__tif__ovr=mrf_text("ovr-mrf-tif", m))
    m.add("ovr-wms-tif", "a.tif", m.tiff(), a__tif__ovr=wms_text(f"{m.url}/ovr-wms-tif"))


@row
def overviews_in_the_file(m):
    for name, file in (("tiff-overview-on-server", f"/vsicurl/{m.url}/tiff-overview-on-server.tif"),
                       ("tiff-overview-document", vrt(source(m.target("tiff-overview-document"))))):
        data = gdal.GetDriverByName("GTiff").Create("/vsimem/overview.tif", SIZE, SIZE, 1, gdal.GDT_Byte)
        data.SetMetadataItem("OVERVIEW_FILE", file, "OVERVIEWS")
        data = None
        m.add(name, "a.tif", content_of("/vsimem/overview.tif"))


@row
def links(m):
    """A link beside a raster or a file of shapes, or in its place."""
    for ending, content in carriers(m):
        name = f"link-{ending}"
        m.add(name, "b.txt", "")
        os.symlink(m.target(f"{name}.{ending}", content), m.inside / name / f"a.{ending}")
        m.documents[-1] = m.documents[-1]._replace(path=str(m.inside / name / f"a.{ending}"))
    for side, content in (("tif.aux.xml", b"<PAMDataset/>"), ("tif.ovr", None), ("tif.msk", None), ("tfw", b"1\n0\n0\n-1\n0\n8\n")):
        name = f"link-side-{side}"
        data = gdal.GetDriverByName("GTiff").Create("/vsimem/plain.tif", SIZE, SIZE, 1, gdal.GDT_Byte)
        data = None
        m.add(name, "a.tif", content_of("/vsimem/plain.tif"))
        os.symlink(m.target(name, content), m.inside / name / f"a.{side}")
    for ending in ("prj", "asc.aux.xml"):
        name = f"link-grid-{ending}"
        m.add(name, "a.asc", GRID)
        os.symlink(m.target(name, b"<PAMDataset/>" if "xml" in ending else b"Projection GEOGRAPHIC\n"),
                   m.inside / name / f"a.{ending}")
    name = "link-shapes"
    m.add(name, "b.txt", "", shapes=True)
    os.symlink(m.target(f"{name}.json", LINE.encode()), m.inside / name / "a.json")
    m.documents[-1] = m.documents[-1]._replace(path=str(m.inside / name / "a.json"))
    m.add("link-csvt", "a.csv", "a,b\n1,2\n", shapes=True)
    os.symlink(m.target("link-csvt", b'"Integer","Integer"\n'), m.inside / "link-csvt" / "a.csvt")


# --- Caches and services ----------------------------------------------------------------------------

def mrf_text(name, m, more="", data="", raster=""):
    return (f'<MRF_META>{more}<Raster><Size x="{SIZE}" y="{SIZE}" c="1"/><PageSize x="{SIZE}" y="{SIZE}" c="1"/>'
            f"<Compression>NONE</Compression><DataType>Byte</DataType>{data or f'<DataFile>{m.target(name)}</DataFile>'}"
            f"{raster}</Raster></MRF_META>")


@row
def mrf(m):
    index = struct.pack(">QQ", 0, 64)
    m.add("mrf-data", "a.mrf", mrf_text("mrf-data", m), a__idx=index)
    m.add("mrf-index", "a.mrf", mrf_text("mrf-index", m, data=f"<IndexFile>{m.target('mrf-index')}</IndexFile>"),
          a__ppg=bytes(64))
    cached = "<CachedSource><Source{1}>{0}</Source></CachedSource>"
    for name, attributes in (("mrf-cached", ""), ("mrf-clone", ' clone="true"')):
        m.add(name, "a.mrf", mrf_text(name, m, cached.format(m.target(name + ".source"), attributes)))
    m.add("mrf-cached-on-server", "a.mrf", mrf_text("mrf-cached-on-server.data", m, cached.format(
        f"/vsicurl/{m.url}/mrf-cached-on-server.tif", "")))
    m.add("mrf-relative", "a.mrf", mrf_text("", m, data="<DataFile>"
          + os.path.relpath(m.target("mrf-relative"), m.inside / "mrf-relative") + "</DataFile>"), a__idx=index)
    m.add("mrf-document", "a.mrf", mrf_text("mrf-document.data", m, cached.format(
        vrt(source(m.target("mrf-document"))).replace("<", "&lt;"), "")))


def wms_text(url, name="TMS", tag="GDAL_WMS", more="", inner=""):
    text = (f'<GDAL_WMS><Service name="{name}">{inner or f"<ServerUrl>{url}</ServerUrl>"}</Service><DataWindow><UpperLeftX>0'
            f"</UpperLeftX><UpperLeftY>{SIZE}</UpperLeftY><LowerRightX>{SIZE}</LowerRightX><LowerRightY>0</LowerRightY>"
            f"<TileLevel>0</TileLevel><SizeX>{SIZE}</SizeX><SizeY>{SIZE}</SizeY></DataWindow><BlockSizeX>{SIZE}</BlockSizeX>"
            f"<BlockSizeY>{SIZE}</BlockSizeY><BandsCount>1</BandsCount>{more}</GDAL_WMS>")
    return text if tag == "GDAL_WMS" else text.lower()


@row
def web_maps(m):
    for service, inner in (("TMS", ""), ("WMS", "<Version>1.1.1</Version><ServerUrl>{}?</ServerUrl><SRS>EPSG:4326</SRS><Layers>a"
                           "</Layers>"), ("WorldWind", ""), ("TileService", "<ServerUrl>{}?</ServerUrl><Dataset>a</Dataset>"),
                           ("TiledWMS", "<ServerUrl>{}?</ServerUrl><TiledGroupName>a</TiledGroupName>"),
                           ("VirtualEarth", "<ServerUrl>{}/${{quadkey}}</ServerUrl>"),
                           ("AGS", "<ServerUrl>{}</ServerUrl>"), ("IIP", "<ServerUrl>{}?</ServerUrl>"),
                           ("MRF", "<ServerUrl>{}</ServerUrl>")):
        name = f"wms-{service}"
        m.add(name, "a.xml", wms_text(f"{m.url}/{name}", service, inner=inner.format(f"{m.url}/{name}") if inner else ""))
    for tag in ("GDAL_WMS", "gdal_wms"):
        memory = gdal.GetDriverByName("MEM").Create("", SIZE, SIZE, 1)
        gdal.GetDriverByName("PNG").CreateCopy("/vsimem/tile.png", memory)
        tile = content_of("/vsimem/tile.png")
        case = "lower" if tag == "gdal_wms" else "upper"
        for name, more in ((f"wms-file-{case}", ""), (f"wms-cache-{case}", f"<Cache><Path>{m.outside}/wms-cache-{case}.made</Path></Cache>")):
            m.target(f"{name}-0.png", tile)
            m.add(name, "a.xml", wms_text(f"file://{m.outside}/{name}-${{z}}.png", tag=tag, more=more))


@row
def other_services(m):
    """Small documents that stand for a whole service."""
    url = m.url
    for name, text in (
            ("wmts", f"<GDAL_WMTS><GetCapabilitiesUrl>{url}/wmts</GetCapabilitiesUrl></GDAL_WMTS>"),
            ("wcs", f"<WCS_GDAL><ServiceURL>{url}/wcs?</ServiceURL><Version>1.0.0</Version><CoverageName>a</CoverageName></WCS_GDAL>"),
            ("wmts-file", f"<GDAL_WMTS><GetCapabilitiesUrl>{m.target('wmts-file', b'<Capabilities/>')}</GetCapabilitiesUrl>"
                          "</GDAL_WMTS>")):
        m.add(name, "a.xml", text)
    m.add("wfs", "a.xml", f"<OGRWFSDataSource><URL>{url}/wfs</URL></OGRWFSDataSource>", shapes=True)


# --- Labels that name their data --------------------------------------------------------------------

def isis3(core, ending="Core"):
    return (f'Object = IsisCube\n  Object = Core\n    StartByte = 1\n    ^{ending} = "{core}"\n    Format = BandSequential\n'
            f"    Group = Dimensions\n      Samples = {SIZE}\n      Lines = {SIZE}\n      Bands = 1\n    End_Group\n"
            "    Group = Pixels\n      Type = UnsignedByte\n      ByteOrder = Lsb\n      Base = 0.0\n      Multiplier = 1.0\n"
            "    End_Group\n  End_Object\nEnd_Object\nEnd\n")


def pds(pointer):
    return ("PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 8\nFILE_RECORDS = 8\n"
            f"^IMAGE = {pointer}\nOBJECT = IMAGE\n  LINES = {SIZE}\n  LINE_SAMPLES = {SIZE}\n  SAMPLE_TYPE = UNSIGNED_INTEGER\n"
            "  SAMPLE_BITS = 8\nEND_OBJECT = IMAGE\nEND\n")


def pds4(name, table=False):
    data = (f"<Array_2D_Image><offset unit=\"byte\">0</offset><axes>2</axes><axis_index_order>Last Index Fastest"
            "</axis_index_order><Element_Array><data_type>UnsignedByte</data_type></Element_Array>"
            f"<Axis_Array><axis_name>Line</axis_name><elements>{SIZE}</elements><sequence_number>1</sequence_number></Axis_Array>"
            f"<Axis_Array><axis_name>Sample</axis_name><elements>{SIZE}</elements><sequence_number>2</sequence_number></Axis_Array>"
            "</Array_2D_Image>")
    if table:
        data = ('<Table_Character><offset unit="byte">0</offset><records>1</records><Record_Character><fields>1</fields><groups>0'
                '</groups><record_length unit="byte">8</record_length><Field_Character><name>a</name><field_location unit="byte">1'
                "</field_location><data_type>ASCII_String</data_type><field_length unit=\"byte\">4</field_length></Field_Character>"
                "</Record_Character></Table_Character>")
    return ('<?xml version="1.0"?><Product_Observational xmlns="http://pds.nasa.gov/pds4/pds/v1"><Identification_Area/>'
            f"<File_Area_Observational><File><file_name>{name}</file_name></File>{data}</File_Area_Observational>"
            "</Product_Observational>")


@row
def labels(m):
    m.add("isis3", "a.lbl", isis3(m.up("isis3")))
    for name, pointer in (("pds", f'"{m.up("pds")}"'), ("pds-offset", f'("{m.up("pds-offset")}", 1)')):
        m.add(name, "a.lbl", pds(pointer))
    m.add("isis2", "a.qub", "CCSD3ZF0000100000001NJPL3IF0PDS200000001 = SFDU_LABEL\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = "
          f'512\n^QUBE = ("{m.up("isis2")}", 1)\nOBJECT = QUBE\n AXES = 3\n AXIS_NAME = (SAMPLE,LINE,BAND)\n CORE_ITEMS = '
          f"({SIZE},{SIZE},1)\n CORE_ITEM_BYTES = 1\n CORE_ITEM_TYPE = UNSIGNED_INTEGER\n CORE_BASE = 0.0\n CORE_MULTIPLIER = "
          "1.0\nEND_OBJECT = QUBE\nEND\n")
    m.add("pds4", "a.xml", pds4(m.up("pds4")))
    m.add("pds4-table", "a.xml", pds4(m.up("pds4-table", b"abcd\r\n  "), table=True), shapes=True)
    m.add("pds4-and-vrt", "a.vrt", "<!-- Product_Observational " + " " * 1200 + "-->\n<OGRVRTDataSource><OGRVRTLayer name=\"a\">"
          f"<SrcDataSource>{m.target('pds4-and-vrt', LINE.encode())}</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>",
          shapes=True)
    m.add("pds4-and-raster-vrt", "a.vrt", "<!-- http://pds.nasa.gov/pds4/pds/v1 Product_Observational -->"
          + vrt(source(m.target("pds4-and-raster-vrt"))))


@row
def headers(m):
    """Other headers that name a file of pixels."""
    m.add("ers", "a.ers", 'DatasetHeader Begin\n Version = "6.0"\n DataFile = "' + m.up("ers") + '"\n DataSetType = ERStorage\n DataType '
          f"= Raster\n ByteOrder = LSBFirst\n RasterInfo Begin\n CellType = Unsigned8BitInteger\n NrOfLines = {SIZE}\n "
          f"NrOfCellsPerLine = {SIZE}\n NrOfBands = 1\n RasterInfo End\nDatasetHeader End\n")
    m.add("ozi-map", "a.map", f"OziExplorer Map Data File Version 2.2\na\n{m.target('ozi-map')}\n1 ,Map Code,\nWGS 84,WGS 84,   "
          "0.0000,   0.0000,WGS 84\nReserved 1\nReserved 2\nMagnetic Variation,,,E\nMap Projection,Latitude/Longitude,PolyCal,No,"
          "AutoCalOnly,No,BSBUseWPX,No\n")
    m.add("ndf", "a.h1", f"NDF_REVISION=2.00;\nDATA_FILE_INTERLEAVING=BSQ;\nPIXELS_PER_LINE={SIZE};\nLINES_PER_DATA_FILE={SIZE};\n"
          f"NUMBER_OF_BANDS_IN_VOLUME=1;\nPIXEL_FORMAT=BYTE;\nBITS_PER_PIXEL=8;\nDATA_SET_TYPE=A;\nBAND1_FILENAME={m.up('ndf')};\n"
          "END_OF_HDR;\n")
    m.add("eir", "a.hdr", "IMAGINE_RAW_FILE\nPIXEL_FILES {0}\nWIDTH 8\nHEIGHT 8\nNUM_LAYERS 1\nDATATYPE U8\nBYTE_ORDER LSB\n"
          "FORMAT BSQ\nDATA_OFFSET 0\n".format(m.up("eir")))
    m.add("dimap", "a.dim", "<Dimap_Document><Metadata_Id><METADATA_FORMAT version=\"1.1\">DIMAP</METADATA_FORMAT></Metadata_Id>"
          f"<Raster_Dimensions><NCOLS>{SIZE}</NCOLS><NROWS>{SIZE}</NROWS><NBANDS>1</NBANDS></Raster_Dimensions><Data_Access>"
          f'<Data_File><DATA_FILE_PATH href="{m.up("dimap")}"/></Data_File></Data_Access></Dimap_Document>')
    m.add("hdf5-external", "a.h5", zlib.decompress(base64.b64decode(HDF5)).replace(
        b"/" + b"n" * 199, os.fsencode(m.target("hdf5-external", struct.pack("<16f", *range(16)))).ljust(200, b"\0")))
    m.add("kml-overlay", "a.kml", '<kml xmlns="http://www.opengis.net/kml/2.2"><Document><GroundOverlay><Icon><href>'
          f"{m.up('kml-overlay')}</href></Icon><LatLonBox><north>1</north><south>0</south><east>1</east><west>0</west>"
          "</LatLonBox></GroundOverlay></Document></kml>")


# --- Shapes -----------------------------------------------------------------------------------------

def ogr_vrt(inner):
    return f'<OGRVRTDataSource><OGRVRTLayer name="a">{inner}</OGRVRTLayer></OGRVRTDataSource>'


@row
def vrts_of_shapes(m):
    def line(name):
        return m.target(name, LINE.encode())

    for name, text in (
            ("ogrvrt", ogr_vrt(f"<SrcDataSource>{line('ogrvrt')}</SrcDataSource><SrcLayer>ogrvrt</SrcLayer>")),
            ("ogrvrt-sql", ogr_vrt(f"<SrcDataSource>{line('ogrvrt-sql')}</SrcDataSource><SrcSQL>SELECT * FROM \"ogrvrt-sql\"</SrcSQL>")),
            ("ogrvrt-sqlite", ogr_vrt(f'<SrcDataSource>{line("ogrvrt-sqlite")}</SrcDataSource><SrcSQL dialect="sqlite">SELECT 1'
                                      "</SrcSQL>")),
            ("ogrvrt-relative", ogr_vrt('<SrcDataSource relativeToVRT="1">'
             + os.path.relpath(line("ogrvrt-relative"), m.inside / "ogrvrt-relative") + "</SrcDataSource><SrcLayer>"
             "ogrvrt-relative</SrcLayer>")),
            ("ogrvrt-warped", '<OGRVRTDataSource><OGRVRTWarpedLayer><OGRVRTLayer name="a"><SrcDataSource>' + line("ogrvrt-warped")
             + "</SrcDataSource></OGRVRTLayer><TargetSRS>EPSG:4326</TargetSRS></OGRVRTWarpedLayer></OGRVRTDataSource>"),
            ("ogrvrt-union", '<OGRVRTDataSource><OGRVRTUnionLayer name="u"><OGRVRTLayer name="a"><SrcDataSource>'
             + line("ogrvrt-union") + "</SrcDataSource><SrcLayer>ogrvrt-union</SrcLayer></OGRVRTLayer></OGRVRTUnionLayer>"
             "</OGRVRTDataSource>"),
            ("ogrvrt-on-server", ogr_vrt(f"<SrcDataSource>/vsicurl/{m.url}/ogrvrt-on-server.json</SrcDataSource>")),
            ("ogrvrt-http", ogr_vrt(f"<SrcDataSource>{m.url}/ogrvrt-http.json</SrcDataSource>"))):
        m.add(name, "a.vrt", text, shapes=True)
    m.add("ogrvrt-lower", "a.vrt", ogr_vrt(f"<SrcDataSource>{line('ogrvrt-lower')}</SrcDataSource><SrcLayer>ogrvrt-lower"
                                           "</SrcLayer>"), shapes=True)


@row
def shapes_that_refer(m):
    for kind in ("link", "url"):
        m.add(f"geojson-crs-{kind}", "a.json", LINE.replace('"features"', f'"crs":{{"type":"{kind}","properties":{{"href":"{m.url}/'
              f'geojson-crs-{kind}","url":"{m.url}/geojson-crs-{kind}","type":"ogcwkt"}}}},"features"'), shapes=True)


# --- Coordinate systems that name files -------------------------------------------------------------

@row
def coordinate_systems(m):
    """A grid of shifts or a file of definitions, which PROJ opens while GDAL opens the document."""
    def proj(name):
        return f"+proj=longlat +ellps=bessel +nadgrids={m.target(name)} +no_defs"

    def grids(name):
        return ('GEOGCS["a",DATUM["b",SPHEROID["c",6377397.155,299.1528128],EXTENSION["PROJ4_GRIDS","' + m.target(name)
                + '"]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')

    def quoted(text):
        return text.replace("&", "&amp;").replace('"', "&quot;")

    own = source("own.tif", attributes=' relativeToVRT="1"')
    for name, text in (("proj", proj), ("wkt", grids), ("init", lambda name: f"+init={m.target(name, b'<1> +proj=longlat <>')}:1")):
        mosaic = f"crs-mosaic-{name}"
        m.add(mosaic, "a.vrt", vrt(f"<SRS>{quoted(text(mosaic))}</SRS>" + own, band="").replace(
            own, f'<VRTRasterBand dataType="Byte" band="1">{own}</VRTRasterBand>'), own__tif=m.tiff())
        entities = f"crs-mosaic-entities-{name}"
        m.add(entities, "a.vrt", vrt("<SRS>" + "".join(f"&#{ord(c)};" for c in text(entities)) + "</SRS>" + own, band="").replace(
            own, f'<VRTRasterBand dataType="Byte" band="1">{own}</VRTRasterBand>'), own__tif=m.tiff())
        points = f"crs-points-{name}"
        m.add(points, "a.vrt", vrt(f'<GCPList Projection="{quoted(text(points))}"><GCP Id="1" Pixel="0" Line="0" X="0" Y="0"/>'
                                   '<GCP Id="2" Pixel="8" Line="0" X="8" Y="0"/><GCP Id="3" Pixel="0" Line="8" X="0" Y="8"/>'
                                   "</GCPList>" + own, band="").replace(
            own, f'<VRTRasterBand dataType="Byte" band="1">{own}</VRTRasterBand>'), own__tif=m.tiff())
        beside = f"crs-beside-{name}"
        m.add(beside, "a.asc", GRID, a__asc__aux__xml=f"<PAMDataset><SRS>{quoted(text(beside))}</SRS></PAMDataset>")
        shapes = f"crs-geojson-{name}"
        crs = text(shapes).replace("\\", "\\\\").replace('"', '\\"')
        m.add(shapes, "a.json", LINE.replace('"features"', f'"crs":{{"type":"name","properties":{{"name":"{crs}"}}}},"features"'),
              shapes=True)
        escaped = f"crs-geojson-escaped-{name}"
        crs = "".join(f"\\u{ord(c):04x}" for c in text(escaped))
        m.add(escaped, "a.json", LINE.replace(
            '"features"', f'"crs":{{"type":"name","properties":{{"name":"{crs}"}}}},"features"'), shapes=True)
    m.add("crs-prj", "a.asc", GRID, a__prj=grids("crs-prj"))
    m.add("crs-prj-upper", "a.asc", GRID, a__PRJ=grids("crs-prj-upper"))
    m.add("crs-envi", "a.dat", bytes(64), a__hdr=f"ENVI\nsamples = 8\nlines = 8\nbands = 1\ndata type = 1\ninterleave = bsq\n"
          "map info = {Geographic Lat/Lon, 1, 1, 0, 8, 1, 1, WGS-84}\n"
          f"coordinate system string = {{{grids('crs-envi')}}}\n")
