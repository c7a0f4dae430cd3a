# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of measured spectra: read, against wavespectra and the files' own sums; and bad ones."""

from __future__ import annotations

import codecs
import gzip
import math
from pathlib import Path

import numpy as np
import pytest

from ocean_tweak.cli import main
from ocean_tweak.core import ParameterError
from ocean_tweak.core.statistics.sea_spectrum import SeaSpectrum
from ocean_tweak.core.statistics.sea_statistics import spectrum_state
from ocean_tweak.export.sea_files import read_sea
from ocean_tweak.export.spectra import text
from ocean_tweak.export.spectra.reading import (
    chosen_place,
    chosen_times,
    measured_sea,
    read_spectra,
)
from ocean_tweak.export.spectra.records import Record
from tests.export.spectrum_files import BUOY_FILES, F, bump, historical, swan_text, write_buoy

NAUTICAL = np.arange(5.0, 360.0, 10.0)
CARTESIAN = np.arange(0.0, 360.0, 15.0)[::-1]


def written(folder: Path, content: str, name: str = "sea.spec") -> Path:
    path = folder / name
    path.write_text(content)
    return path


def only(path: Path) -> Record:
    (record,) = read_spectra([path])
    return record


# SWAN


def test_a_swan_file_is_what_wavespectra_reads_of_it(tmp_path: Path) -> None:
    """Hs, Tp, mean direction and spread, of two wave systems at two times."""
    wavespectra = pytest.importorskip("wavespectra")
    swell, sea = bump(NAUTICAL, 20.0, True, 2.5, s=40.0), bump(NAUTICAL, 130.0, True, 1.2, s=4.0)
    path = written(
        tmp_path, swan_text([swell + sea, sea], directions=NAUTICAL, times=("20200101.00", "20200101.03")[:0]
                            or ("20200101.000000", "20200101.030000")),
    )  # fmt: skip
    record = only(path)
    theirs = wavespectra.read_swan(str(path)).spec
    expected = [theirs.hs(tail=False), theirs.tp(), theirs.dm(), theirs.dspr()]
    for index in range(2):
        own = record.summary(index)
        found = (
            own.significant_wave_height,
            own.peak_period,
            own.comes_from,
            math.degrees(own.directional_spread),
        )
        values = [float(each.values.ravel()[index]) for each in expected]
        assert found[:2] == pytest.approx(values[:2], rel=0.005)
        assert found[2:] == pytest.approx(values[2:], abs=1.0)
        # and the layer's own spectrum is that of the file
        state = spectrum_state(SeaSpectrum(measured_sea(record.at([index]))))
        assert state.significant_wave_height == pytest.approx(values[0], rel=0.005)
        assert (270.0 - math.degrees(state.mean_direction)) % 360.0 == pytest.approx(values[2], abs=1.0)
        assert math.degrees(state.directional_spread) == pytest.approx(values[3], abs=1.0)


@pytest.mark.parametrize("unit", ["m2/Hz/degr", "m2/Hz/rad", "J/m2/Hz/degr"])
@pytest.mark.parametrize("nautical", [True, False])
def test_conventions(tmp_path: Path, nautical: bool, unit: str) -> None:
    """Waves of 2 m towards 70° from east, whatever the file counts from where, and in which unit."""
    directions = NAUTICAL if nautical else CARTESIAN
    per = {"m2/Hz/degr": 1.0, "m2/Hz/rad": 180.0 / math.pi, "J/m2/Hz/degr": 1025.0 * 9.81}[unit]
    spectrum = per * bump(directions, 70.0, nautical)
    path = written(tmp_path, swan_text([spectrum], directions=directions, nautical=nautical, unit=unit))
    state = only(path).summary(0)
    assert state.significant_wave_height == pytest.approx(2.0, rel=0.01)
    assert math.degrees(state.mean_direction) == pytest.approx(70.0, abs=0.1)


def test_several_places_and_times(tmp_path: Path) -> None:
    """The latest time and the first place with energy are taken, others where they are wanted."""
    low, high = bump(NAUTICAL, 0.0, True, 1.0), bump(NAUTICAL, 0.0, True, 3.0)
    times = ("20200102.000000", "20200101.000000", "20200103.000000")
    spectra = ["NODATA", low, high, "ZERO", high, low, "NODATA", low, high]
    path = written(
        tmp_path, swan_text(spectra, places=[(1, 2), (3, 4), (5, 6)], directions=NAUTICAL, times=times)
    )
    records = read_spectra([path])
    assert [record.place for record in records] == ["2 (3, 4)", "3 (5, 6)", "1 (1, 2)"]
    assert [len(record.times) for record in records] == [3, 3, 0]
    first = chosen_place(records, None)
    heights = [first.summary(index).significant_wave_height for index in range(3)]
    assert heights == pytest.approx([3.0, 1.0, 1.0], rel=0.01)  # in the order of time
    assert chosen_times(first, "2020-01-01").summary(0).significant_wave_height == pytest.approx(
        3.0, rel=0.01
    )
    assert len(chosen_times(first, "2020-01-01/2020-01-02T12:00").times) == 2
    assert chosen_place(records, "3").place == "3 (5, 6)"
    for wanted, what in (("4", "is not in the file: it has 2 (3, 4)"), ("1", "no spectrum with energy")):
        with pytest.raises(ParameterError, match=what.replace("(", r"\(").replace(")", r"\)")):
            chosen_place(records, wanted)
    for wanted, what in (("2021-01-01", "nearest is 2020-01-03"), ("soon", "must be a time"),
                         ("2020-01-02/2020-01-01", "exchange")):  # fmt: skip
        with pytest.raises(ParameterError, match=what):
            chosen_times(first, wanted)


def test_a_spectrum_of_frequencies_with_a_direction_and_a_spread(tmp_path: Path) -> None:
    energy = np.exp(-((np.log(F / 0.1) / 0.3) ** 2))
    rows = np.stack([energy, np.full(len(F), 225.0), np.full(len(F), 20.0)], axis=1)
    state = only(written(tmp_path, swan_text([rows], directions=None))).summary(0)
    assert math.degrees(state.mean_direction) == pytest.approx(45.0, abs=1e-6)
    assert math.degrees(state.directional_spread) == pytest.approx(20.0, abs=0.01)


def test_a_place_and_a_time_are_found_by_what_they_are_called(tmp_path: Path) -> None:
    """The first is not the tenth, and an hour of another zone is that of UTC."""
    spectrum = bump(NAUTICAL, 0.0, True)
    places = [(float(number), 0.0) for number in range(10)]
    path = written(tmp_path, swan_text(["ZERO", *[spectrum] * 9], places=places, directions=NAUTICAL))
    records = read_spectra([path])
    assert chosen_place(records, "10").place == "10 (9, 0)"
    with pytest.raises(ParameterError, match="place = '1': has no spectrum with energy"):
        chosen_place(records, "1")
    assert len(chosen_times(records[0], "2020-01-01T01:00+01:00").times) == 1
    with pytest.raises(ParameterError, match="is not in the file"):
        chosen_times(records[0], "2020-01-01T01:00")


def test_frequencies_without_energy_make_no_larger_sea(tmp_path: Path) -> None:
    """Of 1.2 km: four of the longest waves, of which those below 0.07 Hz have a fiftieth of the energy."""
    spectrum = bump(NAUTICAL, 0.0, True)
    more = np.concatenate((np.zeros((2, 36)), spectrum))
    records = (
        only(written(tmp_path, swan_text([each], f=f, directions=NAUTICAL)))
        for f, each in ((F, spectrum), (np.array([0.01, 0.02, *F]), more))
    )
    plain, wide = (measured_sea(record).domain_size for record in records)
    assert plain == wide
    assert 4.0 * 1.56 / 0.08**2 < plain < 4.0 * 1.57 / 0.06**2


@pytest.mark.parametrize("spread", [20.0, 50.0])
def test_a_spread_is_that_of_the_usual_cosine(tmp_path: Path, spread: float) -> None:
    """The second moment too, of cos²ˢ(θ/2), by a sum over θ."""
    rows = np.stack([np.ones(len(F)), np.full(len(F), 270.0), np.full(len(F), spread)], axis=1)
    record = only(written(tmp_path, swan_text([rows], directions=None)))
    r1 = 1.0 - 0.5 * math.radians(spread) ** 2
    theta = np.linspace(-np.pi, np.pi, 4001)
    shape = np.cos(0.5 * theta) ** (2.0 * r1 / (1.0 - r1))
    expected = [float(np.sum(shape * np.cos(order * theta)) / np.sum(shape)) for order in (1, 2)]
    assert record.moments is not None
    np.testing.assert_allclose(record.moments[0, :, ::2], [expected] * len(F), atol=1e-3)
    rows[:, 2] = 300.0  # more than any has: waves go everywhere
    everywhere = only(written(tmp_path, swan_text([rows], directions=None))).moments
    assert everywhere is not None
    assert not everywhere.any()


def test_frequencies_may_be_those_in_the_moving_water(tmp_path: Path) -> None:
    spectrum = bump(NAUTICAL, 0.0, True)
    for word, absolute in (("AFREQ", True), ("RFREQ", False)):
        record = only(written(tmp_path, swan_text([spectrum], directions=NAUTICAL, frequencies=word)))
        assert record.absolute is absolute
        assert record.spectra().absolute is absolute


def test_energy_that_is_missing_is_none(tmp_path: Path) -> None:
    """As the head of the file writes it, whatever the factor: -0.9900E+02."""
    content = swan_text([np.ones((len(F), 36))], directions=NAUTICAL)
    row = " ".join(["99999"] * 36)
    hole = only(written(tmp_path, content.replace(row, " ".join(["-99"] * 18 + ["99999"] * 18), 1)))
    whole = only(written(tmp_path, content))
    np.testing.assert_allclose(hole.energy[0] / whole.energy[0], [0.5, *[1.0] * (len(F) - 1)], rtol=1e-4)


def test_of_spectra_of_one_time_the_first_counts(tmp_path: Path) -> None:
    low, high = (bump(NAUTICAL, 0.0, True, height) for height in (1.0, 3.0))
    times = ("20200101.000000", "20200101.000000", "20200101.010000")
    record = only(written(tmp_path, swan_text([low, high, high], directions=NAUTICAL, times=times)))
    heights = [record.summary(index).significant_wave_height for index in range(2)]
    assert heights == pytest.approx([1.0, 3.0], rel=0.01)
    assert record.notes == ("1 spectra of times that stand twice are left out",)


def test_a_direction_that_is_missing_is_no_angle(tmp_path: Path) -> None:
    """-999 beside energy, at the peak too: as for a buoy it is that of the nearest frequency, and told."""
    energy = np.exp(-((np.log(F / 0.1) / 0.3) ** 2))
    rows = np.stack([energy, np.full(len(F), 225.0), np.full(len(F), 20.0)], axis=1)
    rows[np.argmax(energy), 1] = rows[0, 1] = -999.0
    rows[3, 2] = -9.0  # a spread
    record = only(written(tmp_path, swan_text([rows], directions=None)))
    state = record.summary(0)
    assert math.degrees(state.mean_direction) == pytest.approx(45.0, abs=1e-6)
    assert math.degrees(state.directional_spread) == pytest.approx(20.0, abs=0.01)
    assert record.notes == ("3 frequencies with energy had no direction: they have that of the nearest",)
    rows[:, 1] = -999.0
    nowhere = only(written(tmp_path, swan_text([rows], directions=None)))
    assert nowhere.notes == ("1 spectra had no direction at all: their waves go everywhere",)
    assert nowhere.moments is not None
    assert not nowhere.moments.any()


def test_a_sector_has_no_waves_elsewhere(tmp_path: Path) -> None:
    sector = np.arange(200.0, 300.0, 10.0)
    record = only(written(tmp_path, swan_text([np.ones((len(F), 10))], directions=sector)))
    assert record.shares is not None
    assert record.shares.shape == (1, len(F), 36)
    assert np.count_nonzero(record.shares[0, 0]) == 10
    assert record.summary(0).comes_from == pytest.approx(245.0)


# NDBC


def test_a_buoys_heights_are_sums_over_its_own_bins() -> None:
    """Each bin has a width of its own: 0.005 Hz, then 0.01, then 0.02 (NDBC's technical document 96-01)."""
    (record,) = read_spectra(BUOY_FILES)
    lines = [line for line in BUOY_FILES[0].read_text().splitlines() if not line.startswith("#")]
    assert len(lines) == len(record.times) == 11
    width = np.array([0.005] * 13 + [0.01] * 26 + [0.02] * 7)
    for line in lines:
        stamp = "-".join(line.split()[:3]) + "T" + ":".join(line.split()[3:5])
        energy = np.array([float(word) for word in line.split()[6::2]])
        summary = chosen_times(record, stamp).summary(0)
        assert summary.significant_wave_height == pytest.approx(4.0 * math.sqrt(energy @ width), rel=1e-6)


def test_a_layer_has_the_moments_of_the_buoy() -> None:
    """r₁ and r₂ of the layer's spectrum at each bin are the file's, within 0.02."""
    (record,) = read_spectra(BUOY_FILES)
    latest = chosen_times(record, None)
    (spectrum,) = SeaSpectrum(measured_sea(latest)).layers
    tables = [BUOY_FILES[3].read_text().splitlines()[1].split()[5::2],
              BUOY_FILES[4].read_text().splitlines()[1].split()[5::2]]  # fmt: skip
    r1, r2 = (np.array(words, float) for words in tables)
    theta = np.linspace(0.0, 2.0 * np.pi, 2880, endpoint=False)
    told = (r1 < 2.0) & (r2 < 2.0)
    assert np.count_nonzero(told) > 35
    omega = 2.0 * np.pi * record.f[told]
    density = spectrum.directional_spreading(omega[:, np.newaxis], theta)
    assert np.min(density) >= 0.0
    for order, expected in ((1, r1), (2, r2)):
        found = np.abs(np.mean(density * np.exp(1j * order * theta), axis=1)) * 2.0 * np.pi
        np.testing.assert_allclose(found, expected[told], atol=0.02)


def test_historical_files(tmp_path: Path) -> None:
    """Not in order of time, r in hundredths; packed ones are the same."""
    paths = write_buoy(tmp_path)
    (record,) = read_spectra(paths)
    assert record.place == "41001"
    assert [time.hour for time in record.times if time] == [0, 1]
    assert record.moments is not None
    r1 = np.hypot(record.moments[..., 0], record.moments[..., 1])
    np.testing.assert_allclose(r1, np.repeat([[0.9], [0.8]], len(F), axis=1))
    assert record.summary(0).comes_from == pytest.approx(300.0)
    assert record.summary(1).comes_from == pytest.approx(120.0)
    for path in paths:
        path.with_name(f"{path.name}.gz").write_bytes(gzip.compress(path.read_bytes()))
    (packed,) = read_spectra([path.with_name(f"{path.name}.gz") for path in paths])
    np.testing.assert_array_equal(packed.energy, record.energy)


def test_what_is_missing_is_no_number(tmp_path: Path) -> None:
    paths = write_buoy(tmp_path)
    content = paths[3].read_text().replace("80.00", "999.00", 1).replace("80.00", "99.00", 1)
    paths[3].write_text(content)
    (record,) = read_spectra(paths)
    assert record.moments is not None
    np.testing.assert_allclose(np.hypot(*record.moments[1, :, :2].T), 0.8)
    assert any("had no direction" in note for note in record.notes)
    (alone,) = read_spectra(write_buoy(tmp_path, "41002", missing="k"))
    assert alone.moments is None
    assert any("r2 (swr2, k)" in note for note in alone.notes)


def test_a_frequency_without_a_direction_has_that_of_the_nearest(tmp_path: Path) -> None:
    paths = write_buoy(tmp_path)
    degrees = np.linspace(100.0, 290.0, len(F))
    for path in paths[1:3]:
        path.write_text(historical("d", [("2020 01 01 00 00", degrees), ("2020 01 01 01 00", degrees)]))
    told = paths[1].read_text().splitlines()
    told[1] = " ".join([*told[1].split()[:17], "999.00", "999.00", *told[1].split()[19:]])
    paths[1].write_text("\n".join(told) + "\n")
    (record,) = read_spectra(paths)
    assert record.moments is not None
    a1, b1 = record.moments[0, :, :2].T
    comes_from = np.mod(270.0 - np.degrees(np.arctan2(b1, a1)), 360.0)
    expected = degrees.copy()
    expected[12:14] = degrees[11], degrees[14]
    np.testing.assert_allclose(comes_from, expected, atol=0.01)


def test_files_of_one_time_after_the_other_are_one(tmp_path: Path) -> None:
    """Times without directions are left out; years before 1999 have two digits."""
    paths = write_buoy(tmp_path)
    energy = np.exp(-((np.log(F / 0.12) / 0.35) ** 2))
    older = tmp_path / "41001w1998.txt"
    older.write_text(historical("w", [("98 12 31 23 00", energy)]).replace("#YY ", "YY "))
    (alone,) = read_spectra([older, paths[0]])
    assert [time.year for time in alone.times if time] == [1998, 2020, 2020]
    (record,) = read_spectra([*paths, older])
    assert [time.year for time in record.times if time] == [2020, 2020]
    assert record.notes == ("1 spectra without directions are left out",)


def test_a_wind_that_is_missing_is_that_of_the_time_before(tmp_path: Path) -> None:
    weather = tmp_path / "41001h2020.txt"
    weather.write_text(
        "#YY  MM DD hh mm WDIR WSPD GST  WVHT\n2020 01 01 00 00 270  8.0 10.0  1.0\n"
        "2020 01 01 01 00 999 99.0 99.0 99.00\n"
    )
    (record,) = read_spectra([*write_buoy(tmp_path), weather])
    assert record.wind is not None
    np.testing.assert_allclose(record.wind, [8.0, 8.0], atol=1e-12)


def test_the_weather_gives_the_wind(tmp_path: Path) -> None:
    paths = write_buoy(tmp_path)
    weather = tmp_path / "41001h2020.txt"
    weather.write_text(
        "#YY  MM DD hh mm WDIR WSPD GST  WVHT\n#yr  mo dy hr mn degT m/s  m/s     m\n"
        "2020 01 01 00 00 270  8.0 10.0  1.0\n2020 01 01 01 00 180 12.0 15.0  MM\n"
        "2020 01 01 02 00 999 99.0 99.0 99.00\n"
    )
    (record,) = read_spectra([*paths, weather])
    assert record.wind is not None
    np.testing.assert_allclose(record.wind, [8.0, 12.0j], atol=1e-12)  # from the west, then from the south


# bad files


@pytest.mark.parametrize(
    ("content", "what"),
    [
        ("", "no spectrum of SWAN or of NDBC"),
        ("CDF\x01\x00\x00", "wavespectra writes one for SWAN"),
        ("#YY MM DD hh mm .0200 .0325\n2020 01 01 00 00 1 2\n", "name that does not say what it holds"),
        ("SWAN 1\nTIME\n4\n", "line 3.*option 4"),
        ("SWAN 1\nLOCATIONS\n1\n0 0\nAFREQ\n1\n", "line 6.*from 2 to"),
        ("SWAN 1\nLOCATIONS\n1\n0 0\nAFREQ\n2\n0.1\n0.1\n", "line 8.*all different"),
        ("SWAN 1\nLOCATIONS\n1\n0 0\nAFREQ\n2\n0.1\n0.1000000001\n", "line 8.*all different"),
        ("SWAN 1\nLOCATIONS\n1\n0 x\n", "line 4.*x is no number"),
        ("SWAN 1\nQUANT\n", "line 2.*comes before LOCATIONS"),
        ("SWAN 1\nWIND\n", "line 2.*WIND is none of"),
        ("SWAN 1\n" + "0 " * 150_000, "line 2.*longer than a line of any such file"),
    ],
)  # fmt: skip
def test_bad_files(tmp_path: Path, content: str, what: str) -> None:
    """One line with the file, the line, and what would do."""
    with pytest.raises(ParameterError, match=what) as caught:
        read_spectra([written(tmp_path, content)])
    assert "sea.spec" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_spectrum_that_is_cut_off_uneven_or_empty(tmp_path: Path) -> None:
    whole = swan_text([bump(NAUTICAL, 0.0, True)], directions=NAUTICAL)
    for content, what in (
        (whole[: len(whole) * 2 // 3], "numbers|cut off"),
        (swan_text([np.ones((len(F), 4))], directions=np.array([0.0, 10.0, 25.0, 200.0])), "evenly spaced"),
        (swan_text(["ZERO"], directions=NAUTICAL), "no spectrum with energy"),
        (whole.replace("FACTOR", "FACTORY"), "none of FACTOR"),
        (whole.replace("20200101.000000", "1 Jan"), "no time"),
        (swan_text([bump(NAUTICAL, 0.0, True, height=1e4)], directions=NAUTICAL), r"of 1e\+04 m.*factor"),
    ):
        with pytest.raises(ParameterError, match=what):
            read_spectra([written(tmp_path, content)])
    buoy = write_buoy(tmp_path)
    buoy[0].write_text(buoy[0].read_text()[:-20])
    with pytest.raises(ParameterError, match=r"41001w2020.txt, line 3'.*numbers for the 20 frequencies"):
        read_spectra(buoy)
    with pytest.raises(ParameterError, match="give the file of the energy too"):
        read_spectra(buoy[1:2])
    with pytest.raises(ParameterError, match="all spectra are missing"):
        read_spectra(write_buoy(tmp_path, "41003", scale=0.0))
    packed = tmp_path / "41001w2020.txt.gz"
    packed.write_bytes(gzip.compress(b"x" * 1000)[:20])
    with pytest.raises(ParameterError, match="cannot be unpacked"):
        read_spectra([packed])


@pytest.mark.parametrize(
    ("encoding", "end"), [("utf-8-sig", "\n"), ("utf-16", "\r\n"), ("utf-16-be", "\n"), ("ascii", "\r")]
)
def test_files_that_an_editor_saved_anew(tmp_path: Path, encoding: str, end: str) -> None:
    """With a mark of their encoding, in two bytes a letter, and with the line ends of other systems."""
    content = swan_text([bump(NAUTICAL, 70.0, True)], directions=NAUTICAL)
    plain = only(written(tmp_path, content))
    path = tmp_path / "edited.spec"
    mark = codecs.BOM_UTF16_BE if encoding == "utf-16-be" else b""
    path.write_bytes(mark + content.replace("\n", end).encode(encoding))
    np.testing.assert_array_equal(only(path).energy, plain.energy)
    path.write_bytes(mark + f"SWAN 1{end}LOCATIONS{end}1{end}0 0{end}AFREQ{end}1{end}".encode(encoding))
    with pytest.raises(ParameterError, match=r"edited.spec, line 6'"):
        read_spectra([path])


def test_sizes_are_known_before_anything_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text, "LARGEST_TEXT", 10_000)
    packed = tmp_path / "41001w2020.txt.gz"
    packed.write_bytes(gzip.compress(b"0 " * 10_000_000))
    with pytest.raises(ParameterError, match="is larger than"):
        read_spectra([packed])
    content = swan_text(["ZERO"], directions=NAUTICAL).replace("LOCATIONS\n 1", "LOCATIONS\n 1000000000")
    with pytest.raises(ParameterError, match="from 1 to 10000"):
        read_spectra([written(tmp_path, content)])


# the command


def test_the_command_prints_what_it_found_and_writes_a_sea(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "sea.json"
    assert main(["spectrum", *map(str, BUOY_FILES), "--time", "all", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "41010: 11 spectra with directions, 2020-06-07 17:50 to 2020-06-08 03:50" in printed
    assert "2020-06-08 03:50     1.12 m   5.53 s   159°     111°     50°" in printed
    assert "there are no whitecaps" in printed
    sea = read_sea(out).parameters
    assert sea.layers[0].definition == "MEASURED"
    assert out.stat().st_size < 20_000  # eleven hours of a buoy
    assert main(["spectrum", str(BUOY_FILES[0]), "--time", "2020-06-09"]) == 2


def test_a_sea_is_not_written_over_what_it_is_read_from(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, swan_text([bump(NAUTICAL, 0.0, True)], directions=NAUTICAL))
    before = path.read_bytes()
    assert main(["spectrum", str(path), "--out", str(tmp_path / ".." / tmp_path.name / path.name)]) == 2
    assert "give the sea another name" in capsys.readouterr().err
    assert path.read_bytes() == before


def test_shares_of_what_a_grid_leaves_out_are_plain_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """All waves of 30 Hz and above are shorter than two samples of any sea."""
    f = np.array([30.0, 50.0, 90.0])
    path = written(tmp_path, swan_text([np.full((3, 4), 1e-4)], f=f, directions=np.arange(4) * 90.0))
    assert main(["spectrum", str(path)]) == 0
    assert "100 % of the measured energy" in capsys.readouterr().out
