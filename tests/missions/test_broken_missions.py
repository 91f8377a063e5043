"""Broken mission files, each with every line `swarm check` has to say about it."""

from __future__ import annotations

from pathlib import Path

import pytest

from missions.cli import main
from missions.exit_codes import BAD_INPUT
from missions.mission import faults

BUNDLED = "baboons, crowded, faults, narrow, quickstart, reference, tracks, wildlife"
TOP = (
    "name, description, seed, duration_s, tick_s, arena, home, agents, targets, radio, policy, vehicle, safety, faults"
)
MISSION = "a YAML file with a mission: a mapping with at least a name"
NAME = "a word of letters, digits, '_', '.' and '-', at most 64 long, that starts with a letter or digit"
CORNERS = "a list of 3 to 64 corners [east, north], each number from -50000 to 50000"
LINKS = (
    "a list with a link for each agent: tcp:HOST:PORT, tcpin:HOST:PORT, udpin:HOST:PORT, udpout:HOST:PORT, "
    "serial:DEVICE:BAUD, pty or pty:PATH, or null"
)
ENDPOINTS = "a list with tcp/ADDRESS:PORT for each agent"
NO_RADIO = "faults of another kind: where radio.mode is field, no radio is simulated"
TRACKS = "the path of a CSV of tracks (--set targets.file=PATH)"

FAULTS = "a list of at most 1000 faults, such as [{kind: kill, at_s: 60, agents: [3]}]"
KINDS = f"{', '.join(faults.KINDS[:-1])} or {faults.KINDS[-1]}"
UIDS = "a list of agents' numbers, from 0"

# What the file holds, and the lines expected, without the "m.yaml" that each begins with.
CASES: dict[str, tuple[str, list[str]]] = {
    # Faults.
    "a fault without a kind, and one of another": ("name: m\nfaults:\n  - {at_s: 1}\n  - {kind: fire, at_s: 1}\n", [
        f":3: faults.0.kind: got nothing; allowed: {KINDS}",
        f':4: faults.1.kind: got "fire"; allowed: {KINDS}',
    ]),
    "a fault without its dash": ("name: m\nfaults: {kind: kill, at_s: 1, agents: [0]}\n", [
        f":2: faults: got a mapping; allowed: {FAULTS}",
    ]),
    "faults that are no list": ("name: m\nfaults: 3\n", [f":2: faults: got 3; allowed: {FAULTS}"]),
    "a fault that is none": ("name: m\nfaults: [3]\n", [
        ":2: faults.0: got 3; allowed: a mapping with keys such as kind",
    ]),
    "a fault at no time, of nobody": ("name: m\nfaults:\n  - kind: kill\n    at_s: -1\n", [
        f":3: faults.0.agents: got nothing; allowed: {UIDS}",
        ":4: faults.0.at_s: got -1; allowed: a number from 0 to 1000000",
    ]),
    "a key of another kind": ("name: m\nfaults: [{kind: reboot, at_s: 1, agents: [0], for_s: 3}]\n", [
        ":2: faults.0.for_s: got an unknown key; allowed: kind, at_s, agents",
    ]),
    "agents that there are not": ("name: m\nagents: {count: 3}\nfaults:\n  - {kind: freeze, at_s: 1, agents: [3]}\n", [
        ":4: faults.0.agents: got a list; allowed: numbers from 0 to 2, below agents.count (3)",
    ]),
    "an agent twice": ("name: m\nfaults:\n  - {kind: kill, at_s: 1, agents: [3, 4, 3]}\n", [
        ":3: faults.0.agents: got a list; allowed: each agent once; 3 is there twice",
    ]),
    "an agent in two groups": ("name: m\nfaults:\n  - {kind: partition, at_s: 1, groups: [[0, 1], [1]]}\n", [
        ":3: faults.0.groups: got a list; allowed: each agent in one group",
    ]),
    "a broken part of a real vehicle": (
        "name: m\nagents: {count: 2}\nvehicle: {kind: link, links: [pty, null]}\n"
        "faults: [{kind: gps_lost, at_s: 1, agents: [0]}, {kind: kill, at_s: 1, agents: [0]}]\n", [
        ":4: faults.0.agents: got a list; allowed: agents whose vehicles are simulated: one behind a link "
        "(vehicle.links) has faults of its own",
    ]),
    # One key.
    "negative": ("name: m\nagents:\n  count: 3\n  sensing:\n    range_m: -3\n", [
        ":5: agents.sensing.range_m: got -3; allowed: a number above 0",
    ]),
    "zero where above 0 is asked": ("name: m\nradio: {range_m: 0}\n", [
        ":2: radio.range_m: got 0; allowed: a number above 0",
    ]),
    "too many agents": ("name: m\nagents: {count: 1001}\n", [
        ":2: agents.count: got 1001; allowed: a whole number from 1 to 1000",
    ]),
    "more agents than MAVLink systems": ("name: m\nagents: {count: 251, deployment: {radius_m: 30}}\n", [
        ":2: agents.count: got 251; allowed: at most 250 where vehicle.kind is simulated "
        "(a MAVLink system id is one byte), or vehicle.kind ideal",
    ]),
    "half an agent": ("name: m\nagents: {count: 2.5}\n", [
        ":2: agents.count: got 2.5; allowed: a whole number from 1 to 1000",
    ]),
    "a whole number written as a float": ("name: m\nagents: {count: 2.0}\n", [
        ":2: agents.count: got 2; allowed: a whole number from 1 to 1000",
    ]),
    "text for a number": ('name: m\nduration_s: "240"\n', [
        ':2: duration_s: got "240"; allowed: a number above 0',
    ]),
    "a unit after the number": ("name: m\nduration_s: 240 s\n", [
        ':2: duration_s: got "240 s"; allowed: a number above 0',
    ]),
    "true for a number": ("name: m\nduration_s: true\n", [
        ":2: duration_s: got true; allowed: a number above 0",
    ]),
    "true for a count": ("name: m\nseed: true\n", [
        ":2: seed: got true; allowed: a whole number from 0 to 4294967295",
    ]),
    "1 for true": ("name: m\npolicy:\n  commitment: 1\n", [
        ":3: policy.commitment: got 1; allowed: true or false",
    ]),
    "yes is text in YAML 1.2": ("name: m\npolicy:\n  commitment: yes\n", [
        ':3: policy.commitment: got "yes"; allowed: true or false',
    ]),
    "not a number": ("name: m\nduration_s: .nan\n", [
        ":2: duration_s: got nan; allowed: a number above 0",
    ]),
    "for ever": ("name: m\nduration_s: .inf\n", [
        ":2: duration_s: got inf; allowed: a number above 0",
    ]),
    "null": ("name: m\nduration_s:\nseed: ~\n", [
        ":2: duration_s: got null; allowed: a number above 0",
        ":3: seed: got null; allowed: a whole number from 0 to 4294967295",
    ]),
    "beyond a closed range": ("name: m\nradio:\n  loss: 1.01\n", [
        ":3: radio.loss: got 1.01; allowed: a number from 0 to 1",
    ]),
    "a full turn": ("name: m\nvehicle: {wind: {from_deg: 360}}\n", [
        ":2: vehicle.wind.from_deg: got 360; allowed: a number from 0 to below 360",
    ]),
    "a half-open range": ("name: m\npolicy: {horizon_s: 0}\n", [
        ":2: policy.horizon_s: got 0; allowed: a number above 0, at most 3600",
    ]),
    "negative wind": ("name: m\nvehicle: {wind: {speed_m_s: -1}}\n", [
        ":2: vehicle.wind.speed_m_s: got -1; allowed: a number from 0 to below 100",
    ]),
    "layers above what pilots fly": ("name: m\nagents: {count: 7, altitude: {base_m: 490}}\n", [
        ":2: agents.altitude.layer_m: got 2 (the default); allowed: less: the highest layer is at 502, above 500",
    ]),
    "a search of too many cells": ("name: m\narena: {radius_m: 2000}\npolicy: {explore: stale-first}\n", [
        ':3: policy.explore: got "stale-first"; '
        "allowed: persistent-walk in an arena that is so large beside agents.sensing.range_m",
    ]),
    "below zero where null is allowed": ("name: m\ntargets: {sensing_range_m: -1}\n", [
        ":2: targets.sensing_range_m: got -1; allowed: a number above 0, or null",
    ]),
    "an insane tick": ("name: m\ntick_s: 5\n", [
        ":2: tick_s: got 5; allowed: a number from 0.01 to 1",
    ]),
    "a place at the pole": ("name: m\nhome: {latitude_deg: 90}\n", [
        ":2: home.latitude_deg: got 90; allowed: a number from -85 to 85",
    ]),
    "no name": ("seed: 3\n", [
        f": name: got nothing; allowed: {NAME}",
    ]),
    "a name with a space": ("name: my mission\n", [
        f':1: name: got "my mission"; allowed: {NAME}',
    ]),
    "a number for a name": ("name: 7\n", [
        f":1: name: got 7; allowed: {NAME}",
    ]),
    "a number for text": ("name: m\ndescription: 7\n", [
        ":2: description: got 7; allowed: text",
    ]),
    "an endless number": (f"name: m\nseed: {'9' * 5000}\n", [
        f':2: seed: got "{"9" * 56}...; allowed: a whole number from 0 to 4294967295',
    ]),
    # Choices, of values and of kinds of section.
    "no such predictor": ("name: m\npolicy: {predictor: magic}\n", [
        ':2: policy.predictor: got "magic"; allowed: direct, learned, none or perfect',
    ]),
    "what a study alone can have": ("name: m\npolicy:\n  predictor: perfect\n  answering: optimal\n", [
        ':3: policy.predictor: got "perfect"; allowed: direct, learned or none (perfect is for swarm study alone)',
        ':4: policy.answering: got "optimal"; allowed: distributed (optimal is for swarm study alone)',
    ]),
    "values that come later": (
        "name: m\nvehicle: {kind: glider}\nradio: {mode: smoke}\npolicy: {name: shepherd}\n"
        "agents: {sensing: {field_of_view: periscope}}\n",
        [
            ':2: vehicle.kind: got "glider"; allowed: simulated, ideal or link',
            ':3: radio.mode: got "smoke"; allowed: sim, ideal or field',
            ':4: policy.name: got "shepherd"; allowed: a-cmommt, b-cmommt-basic, b-cmommt or regions',
            ':5: agents.sensing.field_of_view: got "periscope"; allowed: omni, sector or camera',
        ],
    ),
    "links": ("name: m\nagents: {count: 3}\nvehicle:\n  kind: link\n  links: [tcp, 'tcp:h:99999', 7]\n", [
        f':5: vehicle.links.0: got "tcp"; allowed: {LINKS}',
        f':5: vehicle.links.1: got "tcp:h:99999"; allowed: {LINKS}',
        f":5: vehicle.links.2: got 7; allowed: {LINKS}",
    ]),
    "too few links": ("name: m\nvehicle:\n  kind: link\n  links: ['udpin:0.0.0.0:14550', null]\n", [
        ":4: vehicle.links: got a list; allowed: as many as agents.count (10); these are 2",
    ]),
    "a kind without links": ("name: m\nvehicle: {kind: link}\n", [
        ":2: vehicle.links: got a list (the default); allowed: as many as agents.count (10); these are 0",
    ]),
    "links without the kind": ("name: m\nagents: {count: 1}\nvehicle: {links: ['tcp:127.0.0.1:5760']}\n", [
        ":3: vehicle.links: got a list; allowed: none where vehicle.kind is not link",
    ]),
    "slow setpoints of a px4": ("name: m\ntick_s: 0.5\npolicy: {tag_lease_s: 1}\nvehicle: {flavor: px4}\n", [
        ":2: tick_s: got 0.5; "
        "allowed: at most 0.4 where vehicle.flavor is px4: a PX4 wants setpoints at more than 2 Hz",
    ]),
    "a flavor of no autopilot": ("name: m\nvehicle: {flavor: px5}\n", [
        ':2: vehicle.flavor: got "px5"; allowed: ardupilot or px4',
    ]),
    "slow setpoints": (
        "name: m\ntick_s: 0.5\nagents: {count: 1}\npolicy: {tag_lease_s: 1}\n"
        "vehicle: {kind: link, links: ['tcp:127.0.0.1:5760']}\n",
        [
            ":2: tick_s: got 0.5; "
            "allowed: at most 0.4 where vehicle.kind is link: a PX4 wants setpoints at more than 2 Hz",
        ],
    ),
    "one link for two": (
        "name: m\nagents: {count: 2}\nvehicle: {kind: link, links: ['tcp:127.0.0.1:5760', 'tcp:127.0.0.1:5760']}\n",
        [":3: vehicle.links: got a list; allowed: each link once; tcp:127.0.0.1:5760 is there twice"],
    ),
    "system ids": (
        "name: m\nagents: {count: 2}\nvehicle:\n  kind: link\n  links: ['tcp:127.0.0.1:5760', null]\n"
        "  system_ids: [251, 1]\n",
        [":6: vehicle.system_ids.0: got 251; "
         "allowed: a list with a whole number from 1 to 250, or null, for each agent"],
    ),
    "too many system ids": ("name: m\nvehicle: {system_ids: [1]}\n", [
        ":2: vehicle.system_ids: got a list; allowed: none, or as many as vehicle.links (0); these are 1",
    ]),
    "a fence of two corners": ("name: m\nsafety: {fence: {shape: polygon, corners_m: [[0, 1], [1, 0]]}}\n", [
        f":2: safety.fence.corners_m: got a list; allowed: {CORNERS}",
    ]),
    "a corner with a height": (
        "name: m\nsafety:\n  fence: {shape: polygon, corners_m: [[0, 1, 2], [1, 0], [5, 5], [5, 0]]}\n",
        [f":3: safety.fence.corners_m.0: got a list; allowed: {CORNERS}"],
    ),
    "a fence without corners": ("name: m\nsafety: {fence: {shape: polygon}}\n", [
        f":2: safety.fence.corners_m: got nothing; allowed: {CORNERS}",
    ]),
    "a fence of a kind there is not": ("name: m\nsafety:\n  fence: {shape: square}\n", [
        ':3: safety.fence.shape: got "square"; allowed: arena, circle or polygon',
    ]),
    "a battery with nothing to spare": ("name: m\nsafety: {battery_reserve: 1}\n", [
        ":2: safety.battery_reserve: got 1; allowed: a number from 0 to below 1",
    ]),
    "a start outside the fence": (
        "name: m\nsafety: {fence: {shape: polygon, corners_m: [[100, 100], [101, 100], [100, 101]]}}\n",
        [
            ":2: safety.fence.corners_m: got a list; "
            "allowed: corners around every starting place (agent 0 starts outside)",
        ],
    ),
    "a fence inside the start": ("name: m\nsafety: {fence: {shape: circle, radius_m: 10}}\n", [
        ":2: safety.fence.radius_m: got 10; allowed: more than agents.deployment.radius_m (15)",
    ]),
    "a ceiling below the layers": ("name: m\nsafety: {ceiling_m: 20}\n", [
        ":2: agents.altitude.layer_m: got 2 (the default); allowed: less: the highest layer is at 28, above 20",
    ]),
    "no such shape": ("name: m\narena:\n  shape: polygon\n  radius_m: 3\n", [
        ':3: arena.shape: got "polygon"; allowed: disc or rectangle',
    ]),
    "no such motion": ("name: m\ntargets:\n  motion: [fast]\n", [
        ":3: targets.motion: got a list; allowed: evasive, random, static or tracks",
    ]),
    "the other shape's key": ("name: m\narena: {shape: rectangle, radius_m: 30}\n", [
        ":2: arena.radius_m: got an unknown key; allowed: shape, width_m, height_m",
    ]),
    "a count of tracks": (f"name: m\ntargets:\n  motion: tracks\n  file: {__file__}\n  count: 3\n", [
        ":5: targets.count: got an unknown key; allowed: motion, file, start_s, max_gap_s",
    ]),
    "a value for a section": ("name: m\nagents: 10\narena: 30\n", [
        ":2: agents: got 10; allowed: a mapping with keys such as count",
        ":3: arena: got 30; allowed: a mapping with keys such as shape",
    ]),
    "an empty section": ("name: m\nradio:\n", [
        ":2: radio: got null; allowed: a mapping with keys such as mode",
    ]),
    "a list for a section": ("name: m\nradio:\n  - mode: sim\n", [
        ":2: radio: got a list; allowed: a mapping with keys such as mode",
    ]),
    "a section for a value": ("name: m\nseed: {value: 1}\n", [
        ":2: seed: got a mapping; allowed: a whole number from 0 to 4294967295",
    ]),
    # Unknown keys.
    "a misspelled key": ("name: m\nagents:\n  sensing:\n    rang_m: 5\n", [
        ":4: agents.sensing.rang_m: got an unknown key; allowed: range_m, field_of_view, opening_deg, "
        "half_angle_deg, identity_error; did you mean range_m?",
    ]),
    "a misspelled section": ("name: m\nagnets: {count: 3}\n", [
        f":2: agnets: got an unknown key; allowed: {TOP}; did you mean agents?",
    ]),
    "a key like no other": ("name: m\nxyzzy: 1\n", [
        f":2: xyzzy: got an unknown key; allowed: {TOP}",
    ]),
    "a number for a key": ("name: m\n17: 1\n", [
        f":2: 17: got an unknown key; allowed: {TOP}",
    ]),
    "a merge key": ("name: m\n<<: {seed: 3}\n", [
        f":2: <<: got an unknown key; allowed: {TOP}",
    ]),
    "a key of two lines": ('name: m\n"a\\nb": 1\n', [
        f':2: "a\\nb": got an unknown key; allowed: {TOP}',
    ]),
    "a key given twice": ("name: m\nagents:\n  count: 3\n  speed_m_s: 0.4\n  count: 4\n", [
        ":5: agents.count: got a second value (the first is in line 3); allowed: each key once",
    ]),
    "a mapping for a key": ("name: m\n{a: 1}: 2\n", [
        ":2: got a key that is no word; allowed: keys that are words",
    ]),
    # Between keys.
    "mates hear no further than they see": ("name: m\nradio: {range_m: 5.5}\n", [
        ":2: radio.range_m: got 5.5; allowed: more than agents.sensing.range_m (5.5)",
    ]),
    "a default at odds with a value": ("name: m\nagents:\n  sensing: {range_m: 25}\n", [
        ":3: radio.range_m: got 20 (the default); allowed: more than agents.sensing.range_m (25)",
    ]),
    "cameras that see beyond the radio": (
        "name: m\nagents: {count: 3, sensing: {field_of_view: camera, half_angle_deg: 60}}\n",
        [
            ":2: radio.range_m: got 20 (the default); "
            "allowed: more than a camera with agents.sensing.half_angle_deg sees (24.249)",
        ],
    ),
    "a stand-off beyond the lowest camera's sight": (
        "name: m\nagents: {sensing: {field_of_view: camera}}\npolicy: {standoff_m: 2.7}\n",
        [
            ":3: policy.standoff_m: got 2.7; "
            "allowed: less than a camera with agents.sensing.half_angle_deg sees (2.679)",
        ],
    ),
    "an angle that is none": (
        "name: m\nagents: {sensing: {opening_deg: 0, half_angle_deg: 90, identity_error: 1.5}}\n",
        [
            ":2: agents.sensing.opening_deg: got 0; allowed: a number above 0, at most 360",
            ":2: agents.sensing.half_angle_deg: got 90; allowed: a number above 0, at most 85",
            ":2: agents.sensing.identity_error: got 1.5; allowed: a number from 0 to 1",
        ],
    ),
    "slower than evasive targets": ("name: m\nagents: {speed_m_s: 0.3}\n", [
        ":2: agents.speed_m_s: got 0.3; allowed: more than targets.speed_m_s (0.3) of evasive targets",
    ]),
    "slower than random targets": ("name: m\ntargets:\n  motion: random\n  speed_m_s: 1\n", [
        ":4: agents.speed_m_s: got 0.4 (the default); allowed: more than targets.speed_m_s (1) of random targets",
    ]),
    "agents start outside": ("name: m\nagents: {deployment: {radius_m: 31}}\n", [
        ":2: agents.deployment.radius_m: got 31; allowed: at most 30, the largest circle inside the arena",
    ]),
    "targets outside": ("name: m\nagents: {deployment: {radius_m: 14}}\narena: {shape: rectangle, height_m: 29}\n", [
        ":3: targets.deployment.radius_m: got 15 (the default); "
        "allowed: at most 14.5, the largest circle inside the arena",
    ]),
    "no room for all": ("name: m\nagents: {deployment: {radius_m: 1, spacing_m: 1}}\n", [
        ":2: agents.deployment.spacing_m: got 1; allowed: less, to fit 10 agents into agents.deployment.radius_m (1)",
    ]),
    "vehicles too slow": ("name: m\nvehicle: {limits: {speed_m_s: 0.35}}\n", [
        ":2: vehicle.limits.speed_m_s: got 0.35; allowed: at least agents.speed_m_s (0.4)",
    ]),
    "a gale": ("name: m\nvehicle:\n  wind: {speed_m_s: 9, gust_m_s: 1}\n", [
        ":3: vehicle.wind.speed_m_s: got 9; "
        "allowed: with vehicle.wind.gust_m_s (1), less than vehicle.limits.speed_m_s (10)",
    ]),
    "a field radio that is simulated": (
        "name: m\nagents: {count: 2}\nradio: {mode: field, loss: 0.1, latency_s: 0.2}\n"
        "faults: [{kind: loss, at_s: 1}, {kind: partition, at_s: 1, groups: [[0], [1]]}, "
        "{kind: silence, at_s: 1, agents: [0]}]\n", [
        ":3: radio.loss: got 0.1; allowed: 0 where radio.mode is field",
        f':4: faults.0.kind: got "loss"; allowed: {NO_RADIO}',
        f':4: faults.1.kind: got "partition"; allowed: {NO_RADIO}',
        f':4: faults.2.kind: got "silence"; allowed: {NO_RADIO}',
    ]),
    "radios that are nowhere": (
        "name: m\nradio:\n  mode: field\n  endpoints: [udp/h:1, tcp/h, tcp/:1, tcp/h:70000, 'tcp/h:1#x', 7]\n", [
        f':4: radio.endpoints.0: got "udp/h:1"; allowed: {ENDPOINTS}',
        f':4: radio.endpoints.1: got "tcp/h"; allowed: {ENDPOINTS}',
        f':4: radio.endpoints.2: got "tcp/:1"; allowed: {ENDPOINTS}',
        f':4: radio.endpoints.3: got "tcp/h:70000"; allowed: {ENDPOINTS}',
        f':4: radio.endpoints.4: got "tcp/h:1#x"; allowed: {ENDPOINTS}',
        f":4: radio.endpoints.5: got 7; allowed: {ENDPOINTS}",
    ]),
    "too few radios": ("name: m\nradio: {mode: field, endpoints: [tcp/h:1]}\n", [
        ":2: radio.endpoints: got a list; allowed: as many as agents.count (10); these are 1",
    ]),
    "a radio that is shared by others between": (
        "name: m\nagents: {count: 3}\nradio: {mode: field, endpoints: [tcp/h:1, tcp/h:2, tcp/h:1]}\n", [
        ":3: radio.endpoints: got a list; allowed: one endpoint for agents with numbers in a row; tcp/h:1 comes again",
    ]),
    "radios in the air": ("name: m\nagents: {count: 1}\nradio: {endpoints: [tcp/h:1]}\n", [
        ":3: radio.endpoints: got a list; allowed: none where radio.mode is not field",
    ]),
    "an ideal radio that fails": ("name: m\nradio: {mode: ideal, loss: 0.1, latency_s: 0.2}\n", [
        ":2: radio.loss: got 0.1; allowed: 0 where radio.mode is ideal",
        ":2: radio.latency_s: got 0.2; allowed: 0 where radio.mode is ideal",
    ]),
    "a lease that ends at once": ("name: m\npolicy:\n  tag_lease_s: 0.1\n", [
        ":3: policy.tag_lease_s: got 0.1; allowed: at least two tick_s and radio.latency_s (0.2), "
        "or it ends before it is renewed",
    ]),
    "a mission shorter than a tick": ("name: m\nduration_s: 0.05\n", [
        ":2: duration_s: got 0.05; allowed: at least one tick_s (0.1)",
    ]),
    "a standoff out of sight": ("name: m\npolicy: {standoff_m: 6}\n", [
        ":2: policy.standoff_m: got 6; allowed: less than agents.sensing.range_m (5.5)",
    ]),
    "tracks without a file": ("name: m\ntargets:\n  motion: tracks\n", [
        f":2: targets.file: got nothing; allowed: {TRACKS}",
    ]),
    "a number for a file": ("name: m\ntargets:\n  motion: tracks\n  file: 3\n", [
        f":4: targets.file: got 3; allowed: {TRACKS}",
    ]),
    "a file that is not there": ("name: m\ntargets:\n  motion: tracks\n  file: /no/such.csv\n", [
        ':4: targets.file: got "/no/such.csv"; allowed: a file that exists',
    ]),
    # Many at once: kinds of mistakes do not hide each other, nor do wrong keys the rules between the right ones.
    "everything": (
        "nme: m\nseed: -1\nagents:\n  count: 3000\n  count: 3\n  sensing: {range_m: 25}\ntargets:\n  motion: flying\n"
        "vehicle: !drone {}\narena: {shape: disc, width_m: 3}\n",
        [
            f": name: got nothing; allowed: {NAME}",
            f":1: nme: got an unknown key; allowed: {TOP}; did you mean name?",
            ":2: seed: got -1; allowed: a whole number from 0 to 4294967295",
            ":4: agents.count: got 3000; allowed: a whole number from 1 to 1000",
            ":5: agents.count: got a second value (the first is in line 4); allowed: each key once",
            ":6: radio.range_m: got 20 (the default); allowed: more than agents.sensing.range_m (25)",
            ':8: targets.motion: got "flying"; allowed: evasive, random, static or tracks',
            ":9: vehicle: got the YAML tag !drone; allowed: plain values",
            ":10: arena.width_m: got an unknown key; allowed: shape, radius_m",
        ],
    ),
    "a wrong value is not compared": ("name: m\nradio: {range_m: -1}\nagents: {sensing: {range_m: 25}}\n", [
        ":2: radio.range_m: got -1; allowed: a number above 0",
    ]),
    "a misspelled value is not compared": ("name: m\nradio: {range: 30}\nagents: {sensing: {range_m: 25}}\n", [
        ":2: radio.range: got an unknown key; allowed: mode, range_m, endpoints, loss, latency_s; "
        "did you mean range_m?",
    ]),
    "tracks without a file, and more": ("name: m\ntargets: {motion: tracks, start_s: -1}\nradio: {range_m: 5}\n", [
        f":2: targets.file: got nothing; allowed: {TRACKS}",
        ":2: targets.start_s: got -1; allowed: a number, 0 or more",
        ":3: radio.range_m: got 5; allowed: more than agents.sensing.range_m (5.5)",
    ]),
    # No mission at all.
    "an empty file": ("", [f": got an empty file; allowed: {MISSION}"]),
    "only a comment": ("# name: m\n", [f": got an empty file; allowed: {MISSION}"]),
    "a list at the top": ("- name: m\n", [f": got a list; allowed: {MISSION}"]),
    "a word at the top": ("mission\n", [f": got a single value; allowed: {MISSION}"]),
    "a tagged top": ("!mission {name: m}\n", [":1: got the YAML tag !mission; allowed: plain values"]),
    "two documents": ("name: m\n---\nname: n\n", [":2: got bad YAML (but found another document); allowed: YAML 1.2"]),
    "bad indentation": ("name: m\nagents:\n   count: 3\n  speed_m_s: 1\n", [
        ":4: got bad YAML (expected <block end>, but found '<block mapping start>'); allowed: YAML 1.2",
    ]),
    "an open bracket": ("name: [m\n", [
        ":2: got bad YAML (expected ',' or ']', but got '<stream end>'); allowed: YAML 1.2",
    ]),
    "a tab": ("name: m\nagents:\n\tcount: 3\n", [
        ":3: got bad YAML (found character '\\t' that cannot start any token); allowed: YAML 1.2",
    ]),
    "an alias": ("name: m\nagents: &a {count: 3}\nradio: *a\n", [
        ":2: radio: got a YAML alias; allowed: a value written out",
    ]),
    "an alias to itself": ("name: m\nagents: &a [*a]\n", [
        ":2: agents: got a YAML alias; allowed: a value written out",
        ":2: agents: got a list; allowed: a mapping with keys such as count",
    ]),
    "a control character": ("name: m\nseed: \x07\n", [
        ":2: got a character YAML has no place for (U+0007); allowed: YAML 1.2",
    ]),
    "a bottomless pit": ("[" * 5000, [f": got values nested hundreds of levels deep; allowed: {MISSION}"]),
}  # fmt: skip


def checked(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The lines `swarm check` prints of a broken mission, and nothing else."""
    assert main(["check", name]) == BAD_INPUT
    printed = capsys.readouterr()
    assert printed.out == ""
    return printed.err.splitlines()


@pytest.mark.parametrize("case", CASES)
def test_says_all_that_is_wrong(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text, expected = CASES[case]
    monkeypatch.chdir(tmp_path)
    Path("m.yaml").write_text(text, encoding="utf-8")
    assert checked("m.yaml", capsys) == [f"m.yaml{line}" for line in expected]


def test_binary_rubbish(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    Path("m.yaml").write_bytes(b"\x7fELF\x89\x00\xff")
    expected = f"m.yaml: got byte 0x89 at offset 4, which is not UTF-8 text; allowed: {MISSION}"
    assert checked("m.yaml", capsys) == [expected]


def test_a_file_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    Path("m.yaml").write_bytes(b"#" * 1_000_001)
    assert checked("m.yaml", capsys) == ["m.yaml: got more than a megabyte; allowed: the path of a mission file"]


def test_a_directory(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert checked(str(tmp_path), capsys) == [f"{tmp_path}: got a directory; allowed: the path of a mission file"]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("quickstrt", "; did you mean quickstart?"),
        ("quickstart.yaml", "; did you mean quickstart?"),
        ("no/such/wild.yaml", "; did you mean wildlife?"),
        ("zzz", ""),
    ],
)
def test_an_unknown_mission_lists_the_bundled_ones(
    name: str, hint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    allowed = f"the path of a mission file, or a bundled mission ({BUNDLED}){hint}"
    assert checked(name, capsys) == [f"{name}: got no such mission; allowed: {allowed}"]


def test_one_broken_mission_does_not_hide_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.yaml").write_text("name: a\nseed: x\n")
    Path("b.yaml").write_text("name: b\ntick_s: 0\n")
    assert main(["check", "a.yaml", "narrow", "b.yaml"]) == BAD_INPUT
    printed = capsys.readouterr()
    assert printed.out == "narrow: ok (10 agents, evasive targets)\n"
    assert printed.err.splitlines() == [
        'a.yaml:2: seed: got "x"; allowed: a whole number from 0 to 4294967295',
        "b.yaml:2: tick_s: got 0; allowed: a number from 0.01 to 1",
    ]


def test_a_bundled_mission_that_needs_a_file_says_how_to_give_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert checked("baboons", capsys) == [f"baboons.yaml:21: targets.file: got nothing; allowed: {TRACKS}"]
