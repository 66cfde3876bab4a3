#!/usr/bin/python3
"""Makes Wrapping/Python/dspace/stars/bsc5.csv from the fixed-width text of the Yale Bright Star Catalogue.

    Data/generators/make_stars.py bsc5.dat

Source: D. Hoffleit, W. H. Warren Jr., "The Bright Star Catalogue", 5th Revised Ed. (Preliminary Version), Astronomical Data
Center, NSSDC/ADC (1991); public domain. Columns as in its own description (bytes from 1): name 5-14, J2000 right ascension
76-83 and declination 84-90, V 103-107, B-V 110-114, annual proper motion 149-160 [arcsec], parallax 162-166 [arcsec]
with its kind in 161 ('D': dynamical, left out). Names of bright stars are IAU's (WGSN catalogue of star names)."""
import pathlib
import sys

NAMES = {2491: "Sirius", 2326: "Canopus", 5340: "Arcturus", 5459: "Rigil Kentaurus", 7001: "Vega", 1708: "Capella",
         1713: "Rigel", 2943: "Procyon", 472: "Achernar", 2061: "Betelgeuse", 5267: "Hadar", 7557: "Altair",
         4730: "Acrux", 1457: "Aldebaran", 6134: "Antares", 5056: "Spica", 2990: "Pollux", 8728: "Fomalhaut",
         7924: "Deneb", 4853: "Mimosa", 3982: "Regulus", 2618: "Adhara", 2891: "Castor", 4763: "Gacrux",
         6527: "Shaula", 1790: "Bellatrix", 1791: "Elnath", 3685: "Miaplacidus", 1903: "Alnilam", 8425: "Alnair",
         1948: "Alnitak", 4905: "Alioth", 4301: "Dubhe", 1017: "Mirfak", 424: "Polaris", 15: "Alpheratz",
         936: "Algol", 337: "Mirach", 617: "Hamal", 188: "Diphda", 4295: "Merak", 4554: "Phecda", 4660: "Megrez",
         5054: "Mizar", 5191: "Alkaid", 2004: "Saiph", 1852: "Mintaka", 4534: "Denebola", 5563: "Kochab"}


def number(field):
    return float(field) if field.strip() else None


def shown(value, digits):
    return "" if value is None else f"{value:.{digits}f}"


def main(source):
    rows = ["ra_deg,dec_deg,magnitude,color_index,pm_ra,pm_dec,parallax,name"]
    for line in pathlib.Path(source).read_text(encoding="latin-1").splitlines():
        line = line.ljust(197)
        if not line[75:83].strip() or not line[102:107].strip():
            continue  # a nova or a cluster
        ra = 15.0 * (int(line[75:77]) + int(line[77:79]) / 60.0 + float(line[79:83]) / 3600.0)
        dec = int(line[84:86]) + int(line[86:88]) / 60.0 + int(line[88:90]) / 3600.0
        dec = -dec if line[83] == "-" else dec
        parallax = number(line[161:166]) if line[160] != "D" else None
        parallax = parallax if parallax is not None and parallax > 0.0 else None
        rows.append(",".join([f"{ra:.5f}", f"{dec:.5f}", line[102:107].strip(), line[109:114].strip().lstrip("+"),
                              shown(number(line[148:154]), 3), shown(number(line[154:160]), 3), shown(parallax, 3),
                              NAMES.get(int(line[0:4]), "")]))
    target = pathlib.Path(__file__).resolve().parents[2] / "Wrapping/Python/dspace/stars/bsc5.csv"
    target.write_text("\n".join(rows) + "\n")
    print(f"{target}: {len(rows) - 1} stars")


if __name__ == "__main__":
    main(*sys.argv[1:])
