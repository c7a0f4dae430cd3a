// SPDX-License-Identifier: GPL-3.0-or-later
// What Flamenco's manager offers to a job type, as far as ours uses it; compiled() gives the tasks as JSON.
"use strict";

const author = {
    Task: (name, type) => {
        const task = { name: name, type: type, commands: [], dependencies: [] };
        task.addCommand = (command) => task.commands.push(command);
        task.addDependency = (other) => task.dependencies.push(other.name);
        return task;
    },
    Command: (name, parameters) => ({ name: name, parameters: parameters }),
};

// whole frames in order, each once; two neighbours are named, three or more are a range
function frameChunker(frames, size) {
    const all = new Set();
    for (const part of frames.split(",")) {
        const ends = part.split("-").map((text) => parseInt(text, 10));
        for (let frame = ends[0]; frame <= ends[ends.length - 1]; frame++) {
            all.add(frame);
        }
    }
    const sorted = Array.from(all).sort((a, b) => a - b);
    const found = [];
    for (let index = 0; index < sorted.length; index += size) {
        found.push(merged(sorted.slice(index, index + size)));
    }
    return found;
}

function merged(frames) {
    const runs = [];
    for (const frame of frames) {
        const run = runs[runs.length - 1];
        if (run && frame === run[run.length - 1] + 1) {
            run.push(frame);
        } else {
            runs.push([frame]);
        }
    }
    return runs.map((run) => run.length > 2 ? `${run[0]}-${run[run.length - 1]}` : run.join(",")).join(",");
}

function compiled(given) {
    const settings = {};
    for (const setting of JOB_TYPE.settings) {
        settings[setting.key] = setting.key in given ? given[setting.key] : setting.default;
        if (setting.required && settings[setting.key] === undefined) {
            throw new Error("missing " + setting.key);
        }
    }
    const tasks = [];
    compileJob({ settings: settings, addTask: (task) => tasks.push(task) });
    return JSON.stringify({ type: JOB_TYPE, tasks: tasks });
}
